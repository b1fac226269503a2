// Penetration depth of two simple shapes.
//
// 1. Bodies of revolution with parallel axes have the same depth towards all generators. EPA would need too
//    many faces for that. A polygon in the plane of their axes gives their depth instead (convex/meridian.h).
// 2. Otherwise EPA (convex/epa.h) on the difference of the cores. When it is near the answer, Newton's method
//    on the features there (shape_newton.cpp) gives the maximum up to rounding. For shapes with known
//    features, a region around the maximum is proven, and EPA's faces there are removed from the search.
// 3. For curved shapes Newton's method gives the last digits of normal and points, if step 2 did not.
// 4. If it fails, and for flat shapes, candidates for the two points opposite each other are those of the
//    answer, points where cores cross without a common volume, and points of the features around and of
//    parallel faces. Where they are not exact, Newton's method is tried from them.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "fcl_stpbv/convex/epa.h"
#include "fcl_stpbv/convex/meridian.h"
#include "fcl_stpbv/convex/onto_core.h"
#include "fcl_stpbv/convex/shape_curvature.h"
#include "fcl_stpbv/distance/shape_pair.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

namespace {

using Pair = ShapePair;
using Corner = Pair::Corner;
using DepthSearch = Epa<Pair::Difference>;

/// Points of both cores along the answer's normal and along normals next to it: where the supporting faces
/// are generators, discs or polygons, their ends on all sides. Each of A's may be opposite any of B's.
class CornersAround {
 public:
  CornersAround(DepthSearch& epa) : answer_(epa.gap * epa.n) {
    const Vector3d n = epa.n, e = n.unitOrthogonal(), f = n.cross(e);
    add(epa.look(n));
    // The small tilts are for curved sides, and for faces whose angle to each other is as small (rad).
    for (const double tilt : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11})
      for (int k = 0; k < 8; ++k) {
        const double angle = kPi / 4 * k;
        add(epa.look((n + tilt * (std::cos(angle) * e + std::sin(angle) * f)).normalized()));
      }
  }
  /// The support point of the corners' difference, minus the answer.
  Corner support(const Vector3d& m) const {
    const auto lower = [&](const Vector3d& x, const Vector3d& y) { return m.dot(x) < m.dot(y); };
    Corner corner;
    corner.onA = *std::max_element(onA_.begin(), onA_.end(), lower);
    corner.w = *std::min_element(onB_.begin(), onB_.end(), lower) - corner.onA - answer_;
    corner.gap = m.dot(corner.w);
    return corner;
  }

 private:
  void add(const Corner& corner) {
    onA_[count_] = corner.onA;
    onB_[count_++] = corner.onA + corner.w;
  }

  Vector3d answer_;
  std::array<Vector3d, 41> onA_, onB_;
  std::size_t count_ = 0;
};

/// Offers points of both bodies that are opposite each other, from the hulls of those corners.
void offerAround(const Pair& p, DepthSearch& epa) {
  CornersAround around(epa);
  const Vector3d answer = epa.gap * epa.n;
  const Pair::Gjk found =
      gjk<Corner>(around, {}, epa.n, 0.1 * p.rounding, 60, [](double, double) { return false; });
  Simplex<Corner> nearest;
  reduceToNearest(found.simplex, nearest);
  epa.offer(nearest.weighted(&Corner::onA), nearest.weighted(&Corner::w) + answer);
}

/// Offers points by alternating projections. For parallel faces or generators, where the point opposite may
/// be past the other one's end.
void offerToAndFro(const Pair& p, DepthSearch& epa) {
  const Vector3d answer = epa.gap * epa.n;
  Vector3d onA = epa.onA;
  for (int i = 0; i < 4 && epa.off() > p.rounding; ++i) {
    const Vector3d onB = p.pose.placed(ontoCore(p.b, p.pose.inSecond(onA + answer)));
    epa.offer(onA, onB - onA);
    onA = ontoCore(p.a, onB - answer);
  }
}

/// Whether a local maximum is worth searching: EPA takes many steps for round shapes, and the region around
/// the maximum must be known.
bool isCoveredAround(const Pair& p) { return p.curved() && hasAround(p.a) && hasAround(p.b); }

/// The segments, arcs and discs of both cores around two points opposite each other.
LocalMaximum around(const Pair& p, const OppositePoints& at) {
  LocalMaximum local(at.n, -at.gap);
  addShape(p.a, at.onA, at.n, Eigen::Matrix3d::Identity(), local);
  addShape(p.b, p.pose.inSecond(at.onA + at.toB), p.pose.opposite(at.n), p.pose.rotation.matrix(), local);
  return local;
}

}  // namespace

Distance overlapping(const Pair& p, const Pair::Gjk& found) {
  Pair::Difference difference(p.a, p.b, p.pose);
  DepthSearch epa(difference, p.rounding);
  // No gap is wider than the two points that GJK found are apart, even where rounding hid it.
  Simplex<Corner> common;
  reduceToNearest(found.simplex, common);
  const Vector3d onA = common.weighted(&Corner::onA), toB = common.weighted(&Corner::w);
  epa.bound = std::min(found.upper, toB.norm());
  Meridian plane;
  if (commonMeridian(p.a, p.b, p.pose, plane)) {
    const MeridianDepth inner =
        meridianDepth(plane, p.rounding, [&](const Vector3d& m) { return epa.look(-m.normalized()); });
    if (inner.depth > 0.0) epa.bound = std::min(epa.bound, -inner.depth);
    if (inner.found) epa.offer(inner.onA, inner.toB);
  }
  std::optional<OppositePoints> top;
  const auto opposite = [&](double angle) {
    return nearestOnFeatures(p.a, p.b, p.pose, {epa.n, epa.gap, epa.onA, angle}, p.rounding);
  };
  // Likely error of the normal (rad), if the difference's radii of curvature are much larger than the depth.
  // Otherwise the error may be any angle.
  const auto likelyOff = [&] {
    const double open = std::max(epa.bound - epa.gap, p.rounding);
    return 4.0 * std::sqrt(open / std::max(-epa.gap, p.rounding));
  };
  const auto maximum = [&](DepthSearch&) -> std::optional<LocalMaximum> {
    top = opposite(std::min(likelyOff(), Pair::kWidest));
    if (!top) return {};
    epa.n = top->n, epa.gap = top->gap;
    epa.offer(top->onA, top->toB);
    return around(p, *top);
  };
  if (isCoveredAround(p))
    epa.run(maximum);
  else
    epa.run();
  // Moves to the maximum on the features near the answer. False if there is none.
  const auto polish = [&] {
    const double likely = likelyOff();
    top = opposite(std::min(likely, Pair::kWidest));
    if (!top && likely < Pair::kWidest) top = opposite(Pair::kWidest);
    if (!top && epa.gap > 0.0) top = oppositeLevel(p, epa.n);  // apart, where GJK could not tell
    if (!top) return false;
    epa.n = top->n;
    epa.gap = top->gap;
    epa.onA = top->onA;
    if (epa.gap > 0.0) epa.bound = std::min(epa.bound, top->toB.norm());
    return true;
  };
  const bool isPolished = (top && top->gap == epa.gap) || (p.curved() && polish());
  if (!isPolished) {
    epa.offer(onA, toB);  // the answer if the cores cross without a common volume, as two segments do
    if (epa.off() > p.rounding) offerAround(p, epa);
    if (epa.off() > p.rounding) offerToAndFro(p, epa);
    if (p.curved() || epa.off() > p.rounding || !(epa.bound - epa.gap <= p.rounding)) polish();
  }
  Distance result = p.inWorld(epa.n, epa.onA, epa.gap * epa.n);
  const double upper = std::max(epa.bound, epa.gap);
  result.status = upper - epa.gap <= p.rounding ? DistanceStatus::exact : DistanceStatus::bounded;
  result.distance = epa.gap - p.margins();
  result.lower = result.distance - p.certificate;
  result.upper = upper - p.margins() + p.certificate;
  return result;
}

}  // namespace fcl_stpbv::detail
