// Two simple shapes: GJK between their cores where these are apart, EPA where
// they overlap (convex/gjk.h, epa.h).
//
// 1. Put the pair into one order, so that both orders of a call are the same query.
// 2. Half spaces and planes: the gap along their normal is all there is to know.
// 3. GJK with the duality gap as its stop. Its upper bound is the distance of two points of the bodies, its
//    lower one the gap between the supporting planes of the answer's normal.
// 4. Overlap: bodies of revolution on parallel axes are as deep towards all generators as towards one, more
//    than EPA has room for; a polygon in the plane of their axes tells their depth. Then EPA.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "fcl_stpbv/convex/epa.h"
#include "fcl_stpbv/convex/gjk.h"
#include "fcl_stpbv/convex/meridian.h"
#include "fcl_stpbv/convex/onto_core.h"
#include "fcl_stpbv/convex/support.h"
#include "fcl_stpbv/distance/shape_distance.h"
#include "fcl_stpbv/distance/shape_newton.h"

namespace fcl_stpbv {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

using namespace detail;
using Difference = ConvexDifference<const Shape, const Shape>;
using Corner = Difference::Corner;
using Gjk = GjkResult<Corner>;

/// Whether a pair comes first in the one order of both: by kind, then size, then place.
bool comesFirst(const Shape& a, const Isometry3d& poseA, const Shape& b, const Isometry3d& poseB) {
  if (a.unbounded() != b.unbounded()) return a.unbounded();
  if (a.kind != b.kind) return a.kind < b.kind;
  if (a.reach != b.reach) return a.reach < b.reach;
  if (a.margin != b.margin) return a.margin < b.margin;
  if (a.vertexCount != b.vertexCount) return a.vertexCount < b.vertexCount;
  if (a.radius != b.radius) return a.radius < b.radius;
  if (a.half != b.half) return a.half < b.half;
  for (int i = 0; i < 3; ++i) {
    if (a.size[i] != b.size[i]) return a.size[i] < b.size[i];
    if (a.centre[i] != b.centre[i]) return a.centre[i] < b.centre[i];
  }
  const double* x = poseA.data();
  const double* y = poseB.data();
  return std::lexicographical_compare(x, x + 16, y, y + 16);
}

/// A pair in its one order, the first one's frame.
struct Pair {
  const Shape &a, &b;
  RelativePose pose;
  double rounding = 0.0;     ///< of a gap (m)
  double certificate = 0.0;  ///< bound on it, of the poses that lead to it too (m)
  bool valid = false;

  Pair(const Shape& first, const Isometry3d& poseA, const Shape& second, const Isometry3d& poseB)
      : a(first), b(second), pose(poseA, poseB) {
    if (!pose.valid || !a.valid() || !b.valid() || (a.unbounded() && b.unbounded())) return;
    const double size = unpack(pose.translation).lpNorm<1>() + a.centre.lpNorm<1>() + a.reach +
                        b.centre.lpNorm<1>() + b.reach;
    rounding = 8.0 * std::numeric_limits<double>::epsilon() * size;
    certificate = kGapRounding * (size + a.margin + b.margin);
    valid = rounding < 1e100;  // squares of squares must not overflow
  }

  double margins() const { return a.margin + b.margin; }

  /// Whether GJK only comes near the answer, by chords of a round surface.
  bool curved() const { return curved(a) || curved(b); }
  static bool curved(const Shape& s) {
    return s.kind == ShapeKind::cylinder || s.kind == ShapeKind::cone || s.kind == ShapeKind::ellipsoid;
  }

  /// GJK from what an earlier search ended with, until both bounds agree or `told(lower, upper)` says that it
  /// has heard enough.
  template <typename Told>
  Gjk search(const Told& told, const Simplex<Corner>& start = {}) const {
    constexpr int kSteps = 120;  // polytopes take a dozen, round bodies some thirty
    const Vector3d d = pose.placed(b.centre) - a.centre;
    Difference difference(a, b, pose);
    return gjk<Corner>(difference, start, d.norm() > rounding ? Vector3d(d.normalized()) : Vector3d::UnitX(),
                       rounding, kSteps, [&](double lower, double upper) {
                         return upper - lower <= 0.5 * rounding || told(lower, upper);
                       });
  }
};

/// What a search found, in the world: `n` from A to B, `onA` a point of A's
/// core, `toB` from there to B's core.
Distance inWorld(const Pair& p, const Vector3d& n, const Vector3d& onA, const Vector3d& toB) {
  Distance result;
  result.normal = p.pose.normalInWorld(n);
  result.point = {p.pose.inWorld(onA + p.a.margin * n), p.pose.inWorld(onA + toB - p.b.margin * n)};
  return result;
}

Gjk searchToTheEnd(const Pair& p, const Simplex<Corner>& start = {}) {
  return p.search([](double, double) { return false; }, start);
}

/// Whether the bounds are near enough for Newton's method on the features there: those of round bodies are
/// few, a polytope's are told apart by the last digits.
bool isNear(const Pair& p, double lower, double upper) {
  const double part = p.curved(p.a) && p.curved(p.b) ? 1e-2 : 1e-5;
  return upper - lower <= part * upper;
}

/// The widest gap that a search has seen, and its normal.
struct WidestGap {
  double gap;
  Vector3d n;

  /// The last normal, which the search did not look at. Rounding can make it worse than an earlier one.
  WidestGap(const Pair& p, const Gjk& found)
      : gap(Difference(p.a, p.b, p.pose).support(found.n).gap), n(found.n) {
    if (found.lower > gap) gap = found.lower, n = found.widest;
  }
};

constexpr double kWidest = 0.1;  // most that a normal may be off by before Newton's method (rad)

/// Cores apart, as a search knows them: `exact` where its bounds agree. `invalid` where no gap between them
/// was found.
Distance asFound(const Pair& p, const Gjk& found, const WidestGap& widest) {
  if (!(widest.gap > 0.0)) return {};
  Distance result = inWorld(p, widest.n, found.simplex.weighted(&Corner::onA), found.v);
  const double upper = std::max(found.upper, widest.gap);
  result.status = upper - widest.gap <= p.rounding ? DistanceStatus::exact : DistanceStatus::bounded;
  result.distance = upper - p.margins();
  result.lower = widest.gap - p.margins() - p.certificate;
  result.upper = result.distance + p.certificate;
  return result;
}

/// Cores apart: as found, or with the last digits of normal and points by Newton's method, where chords of a
/// round surface or the rounding of points that all but touch left them open. `invalid` where the cores
/// overlap, or no gap between them was found.
Distance separated(const Pair& p, const Gjk& found) {
  if (found.verdict == Gjk::Verdict::overlap) return {};
  const WidestGap widest(p, found);
  Distance result = asFound(p, found, widest);
  const bool opposite = (found.v - widest.gap * widest.n).norm() <= 2.0 * p.rounding;
  // A chord of a rim is as good as its arc for the gap, but its normal is off by the root of rounding.
  if (result.status == DistanceStatus::exact && opposite && !p.curved()) return result;
  // Seen from its point nearest to the origin, the difference lies beyond the plane of the widest gap.
  const double open = std::max(found.upper - widest.gap, p.rounding);
  const double angle = std::min(std::sqrt(2.0 * open / found.upper), kWidest);
  const Vector3d& n = widest.gap > 0.0 ? widest.n : found.n;
  const auto nearest = nearestOnFeatures(p.a, p.b, p.pose, n, widest.gap,
                                         found.simplex.weighted(&Corner::onA), angle, p.rounding);
  if (!nearest || !(nearest->gap > 0.0)) {
    if (p.curved() && !opposite && result.status == DistanceStatus::exact)
      result.status = DistanceStatus::bounded;
    return result;
  }
  result = inWorld(p, nearest->n, nearest->onA, nearest->toB);
  result.status = DistanceStatus::exact;
  result.distance = nearest->gap - p.margins();
  result.lower = result.distance - p.certificate;
  result.upper = std::max(nearest->toB.norm(), nearest->gap) - p.margins() + p.certificate;
  return result;
}

/// Corners of the difference along normals next to the answer's, less the answer: where the supporting faces
/// are generators or discs, their ends, on all sides.
struct CornersAround {
  std::array<Corner, 24> corner;

  CornersAround(Epa<Difference>& epa) {
    const Vector3d n = epa.n, e = n.unitOrthogonal(), f = n.cross(e);
    std::size_t i = 0;
    for (const double tilt : {1e-3, 1e-5, 1e-7})  // rad; the narrower ones for curved sides
      for (int k = 0; k < 8; ++k) {
        const double angle = 0.785398163397448 * k;
        corner[i++] = epa.look((n + tilt * (std::cos(angle) * e + std::sin(angle) * f)).normalized());
      }
    for (Corner& c : corner) c.w -= epa.gap * epa.n;
  }
  Corner support(const Vector3d& m) {
    Corner best;
    best.gap = std::numeric_limits<double>::infinity();
    for (const Corner& c : corner)
      if (m.dot(c.w) < best.gap) best = c, best.gap = m.dot(c.w);
    return best;
  }
};

/// Points of both bodies that are opposite each other, out of those corners.
void offerAround(const Pair& p, Epa<Difference>& epa) {
  CornersAround around(epa);
  const Vector3d answer = epa.gap * epa.n;
  const Gjk found =
      gjk<Corner>(around, {}, epa.n, 0.1 * p.rounding, 60, [](double, double) { return false; });
  Simplex<Corner> nearest;
  reduceToNearest(found.simplex, nearest);
  epa.offer(nearest.weighted(&Corner::onA), nearest.weighted(&Corner::w) + answer);
}

/// The same of faces or generators side by side, where a point may be opposite one past the other's end.
void offerToAndFro(const Pair& p, Epa<Difference>& epa) {
  const Vector3d answer = epa.gap * epa.n;
  Vector3d onA = epa.onA;
  for (int i = 0; i < 4 && epa.off() > p.rounding; ++i) {
    const Vector3d onB = p.pose.placed(ontoCore(p.b, p.pose.inSecond(onA + answer)));
    epa.offer(onA, onB - onA);
    onA = ontoCore(p.a, onB - answer);
  }
}

/// Cores with a common point, as far as GJK could tell: the shortest translation that separates them.
Distance overlapping(const Pair& p, const Gjk& found) {
  Difference difference(p.a, p.b, p.pose);
  Epa<Difference> epa(difference, p.rounding);
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
  epa.run();
  epa.offer(onA, toB);  // the answer's where cores cross without a volume in common, as two segments do
  if (epa.off() > p.rounding) offerAround(p, epa);
  if (epa.off() > p.rounding) offerToAndFro(p, epa);
  if (p.curved() || epa.off() > p.rounding || !(epa.bound - epa.gap <= p.rounding)) {
    const auto deepest = nearestOnFeatures(p.a, p.b, p.pose, epa.n, epa.gap, epa.onA, kWidest, p.rounding);
    if (deepest) {
      epa.n = deepest->n;
      epa.gap = deepest->gap;
      epa.onA = deepest->onA;
    }
  }
  Distance result = inWorld(p, epa.n, epa.onA, epa.gap * epa.n);
  const double upper = std::max(epa.bound, epa.gap);
  result.status = upper - epa.gap <= p.rounding ? DistanceStatus::exact : DistanceStatus::bounded;
  result.distance = epa.gap - p.margins();
  result.lower = result.distance - p.certificate;
  result.upper = upper - p.margins() + p.certificate;
  return result;
}

/// A half space or a plane `a`. A plane is left by the nearer side.
Distance besidePlane(const Pair& p) {
  const auto side = [&](const Vector3d& n, double offset) {
    const Vector3d q = p.pose.placed(p.b.support(p.pose.opposite(n)));
    const double gap = n.dot(q) - offset;
    Distance result = inWorld(p, n, q - gap * n, gap * n);
    result.status = DistanceStatus::exact;
    result.distance = gap - p.b.margin;
    result.lower = result.distance - p.certificate;
    result.upper = result.distance + p.certificate;
    return result;
  };
  const Vector3d n = p.a.normal.normalized();
  const Distance one = side(n, p.a.offset);
  if (p.a.kind != ShapeKind::plane) return one;
  const Distance other = side(-n, -p.a.offset);
  return other.distance > one.distance ? other : one;
}

/// The same after a search that goes on to the end, where Newton's method had no success from `found`.
Distance separatedAtTheEnd(const Pair& p, Gjk& found) {
  for (Corner& corner : found.simplex.corner) corner.gap = -std::numeric_limits<double>::infinity();
  found = searchToTheEnd(p, found.simplex);  // seen along new normals
  return separated(p, found);
}

Distance solve(const Pair& p) {
  if (!p.valid) return {};
  if (p.a.unbounded()) return besidePlane(p);
  Gjk found = p.search([&](double lower, double upper) { return p.curved() && isNear(p, lower, upper); });
  Distance result = separated(p, found);
  if (result.status == DistanceStatus::bounded && p.curved()) result = separatedAtTheEnd(p, found);
  return result.status == DistanceStatus::invalid ? overlapping(p, found) : result;
}

bool isFarther(double x, const Pair& p) {
  if (!p.valid) return false;
  if (p.a.unbounded()) return besidePlane(p).lower > x;
  const double core = x + p.margins();
  Gjk found =
      p.search([&](double lower, double upper) { return lower > core + p.certificate || upper <= core; });
  if (found.lower > core + p.certificate) return true;  // along whatever normal, apart or not
  if (found.verdict != Gjk::Verdict::overlap && found.upper <= core) return false;
  Distance answer = separated(p, found);
  if (answer.status == DistanceStatus::bounded && p.curved() && answer.lower <= x && x < answer.upper)
    answer = separatedAtTheEnd(p, found);
  if (answer.status != DistanceStatus::invalid) return answer.lower > x;
  return core < 0.0 && overlapping(p, found).lower > x;
}

}  // namespace

Distance distance(const Shape& a, const Isometry3d& poseA, const Shape& b, const Isometry3d& poseB) {
  if (comesFirst(a, poseA, b, poseB)) return solve({a, poseA, b, poseB});
  Distance result = solve({b, poseB, a, poseA});
  result.normal = -result.normal;
  std::swap(result.point[0], result.point[1]);
  return result;
}

bool isFartherThan(double x, const Shape& a, const Isometry3d& poseA, const Shape& b,
                   const Isometry3d& poseB) {
  return comesFirst(a, poseA, b, poseB) ? isFarther(x, {a, poseA, b, poseB})
                                        : isFarther(x, {b, poseB, a, poseA});
}

// The corners around the origin of the difference weigh points of the bodies that coincide; cores that are
// apart meet where their margins do.
Vector3d commonPoint(const Shape& a, const Isometry3d& poseA, const Shape& b, const Isometry3d& poseB) {
  const Pair p(a, poseA, b, poseB);
  Simplex<Corner> around;
  const NearestPoint nearest = reduceToNearest(searchToTheEnd(p).simplex, around);
  const double share = p.margins() > 0.0 ? a.margin / p.margins() : 0.5;
  return p.pose.inWorld(around.weighted(&Corner::onA) + share * nearest.point);
}

}  // namespace fcl_stpbv
