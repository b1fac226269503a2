// Penetration depth of an STP-BV and a simple shape whose cores overlap, by the depth of a single point of
// the shape, or else by EPA. (Between the two the normal cones of a flat shape are tried, in
// cone_overlap.cpp.)
//
// A single point (the proof is in docs/theory.md, 5):
// 1. Take the shape's point that faces the volume along the start's normal.
// 2. Compute its shortest way out of the volume in closed form (volume/point_depth.h).
// 3. If no other point of the shape needs a longer way along that direction, the depth of the shape is that
//    of the point. Otherwise continue with the point that does, until the search alternates between points.
//
// EPA:
// 1. EPA (convex/epa.h) on the difference of the two cores bounds the depth.
// 2. When EPA is near the answer, the maximum on one feature of the shape (deep_features.cpp) gives the
//    normal and points up to rounding. EPA's faces around it are then removed from the search.
#include <algorithm>
#include <cmath>
#include <optional>

#include "fcl_stpbv/convex/epa.h"
#include "fcl_stpbv/convex/support.h"
#include "fcl_stpbv/distance/shape_query.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/point_depth.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

namespace {

/// The difference of the volume's core and the shape's core. Its corners also store the shape's point.
class ShapeDifference {
 public:
  struct Corner {
    Vector3d w{0, 0, 0};      ///< the point of the difference (m)
    Vector3d onA{0, 0, 0};    ///< the volume's part of it
    double gap = 0;           ///< between the supporting planes that it was found with (m)
    Vector3d shape{0, 0, 0};  ///< the shape's part, in the volume's frame
  };

  explicit ShapeDifference(ShapeQuery& q) : q_(q) {}

  /// EPA's normals jump back and forth, so the search for the patch starts from a table, not from the last
  /// patch.
  Corner support(const Vector3d& n) {
    const SupportPoint p = viewVolume(q_.body, n, -1, q_.steps);
    const Vector3d y = q_.facing(n);
    ++q_.pairs;
    return {y - p.point, p.point, p.gap(y), y};
  }

 private:
  ShapeQuery& q_;
};

/// Improves the best normal if rounding or the size of the polytope stopped EPA: tries normals around it, at
/// smaller and smaller angles.
template <typename Search>
void climbToLeastOverlap(Search& epa) {
  constexpr int kTrials = 4000;
  double step = 0.02;  // rad
  for (int trials = 0; step > 1e-9 && trials < kTrials;) {
    const Vector3d n = epa.n, e = n.unitOrthogonal(), f = n.cross(e);
    const double gap = epa.gap;
    for (int k = 0; k < 8 && epa.gap <= gap; ++k, ++trials) {
      const double angle = kPi / 4 * k + 40.0 * step;  // another direction in each round
      epa.look((n + step * (std::cos(angle) * e + std::sin(angle) * f)).normalized());
    }
    if (epa.gap <= gap) step *= 0.5;
  }
}

/// The shape's corners of EPA's answer, without duplicates.
template <typename Search>
ShapeCorners cornersMet(const Search& epa) {
  ShapeCorners met;
  for (int i = 0; i < epa.metCount; ++i) {
    const Vector3d& p = epa.met[at(i)].shape;
    if (std::find(met.p.begin(), met.p.begin() + met.count, p) == met.p.begin() + met.count)
      met.p[at(met.count++)] = p;
  }
  return met;
}

}  // namespace

std::optional<LeastOverlap> overlapOfPoint(ShapeQuery& q, const StartNormal& start) {
  constexpr int kRounds = 8;  // one or two for corners, a few for round shapes
  constexpr int kFree = 2;    // rounds before steps must shrink
  // Of the last round's step. A larger step means that the search alternates between points.
  constexpr double kSlow = 0.25;
  Vector3d y = q.facing(start.n);
  double step = kInfinity;
  for (int i = 0; i < kRounds; ++i) {
    const std::optional<PointDepth> way = pointDepth(q.body, y);
    ++q.pairs;
    if (!way) break;
    const Vector3d last = q.facing(way->normal);
    const double next = (last - y).norm();
    if (next <= q.rounding.gap) {
      const SupportPoint view = viewVolume(q.body, way->normal, way->patch, q.steps);
      LeastOverlap found{{}, 0.0};
      found.at.n = way->normal;
      found.at.patch = view.patch;
      found.at.y = y;
      found.at.gap = view.gap(y);
      found.bound = std::max(-way->depth, found.at.gap) + q.rounding.across;
      if (!(found.at.gap >= -way->depth - q.rounding.gap)) break;
      return found;
    }
    if (i >= kFree && next > kSlow * step) break;
    step = next;
    y = last;
  }
  return {};
}

LeastOverlap leastOverlap(ShapeQuery& q, const StartNormal& start) {
  ShapeDifference difference(q);
  Epa<ShapeDifference> epa(difference, q.rounding.gap, q.body.radii().rho);
  epa.look(start.n);
  std::optional<DeepFeature> top;
  bool ascend = false;
  const auto maximum = [&](Epa<ShapeDifference>& search) -> std::optional<LocalMaximum> {
    top = deepestFeature(q, {search.n, -1}, search.gap, cornersMet(search), ascend);
    if (!top) return {};
    if (top->at.gap > search.gap) search.gap = top->at.gap, search.n = top->at.n;
    return top->around;
  };
  if (!epa.run(maximum)) climbToLeastOverlap(epa);
  if (!top || epa.gap > top->at.gap + q.rounding.gap) {
    ascend = true;
    maximum(epa);
  }
  // The polytope's points are off by the rounding of the volume's core points.
  LeastOverlap best{{}, std::max(epa.bound, epa.gap) + q.rounding.across};
  if (top) {
    best.at = top->at;
    return best;
  }
  best.at.n = epa.n;
  best.at.gap = epa.gap;
  best.at.y = epa.onB();
  return best;
}

}  // namespace fcl_stpbv::detail
