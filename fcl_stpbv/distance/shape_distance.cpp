// An STP-BV against a simple shape.
//
// 1. Search the shape's nearest feature, with a method for each kind of shape (shape_query.h), starting from
//    the cached normal or the line of centres.
// 2. Test the answer against the whole shape. If it holds, it is exact.
// 3. Otherwise bisect the remaining directions with support points of the two whole bodies
//    (convex/direction_cone.h), which is slow but reliable. From the normal found, a second feature search
//    proves the last digits.
// 4. For cores that overlap (detected by a ball inside the volume, or by GJK), three methods in turn: a
//    single point's way out through a face (shape_overlap.cpp), the normal cones of a flat shape
//    (cone_overlap.cpp), and EPA (shape_overlap.cpp).
#include <algorithm>
#include <cmath>
#include <optional>

#include "fcl_stpbv/convex/direction_cone.h"
#include "fcl_stpbv/convex/gjk.h"
#include "fcl_stpbv/convex/onto_core.h"
#include "fcl_stpbv/convex/support.h"
#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/distance/shape_query.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

using namespace detail;

/// Half spaces and planes have one or two normals. The distance is the gap along one of them.
Nearest nearestOnHalfspace(ShapeQuery& q) {
  const Vector3d normal = (q.rotation * q.shape.normal).normalized();
  const Vector3d onPlane = q.pose.placed(q.shape.offset * q.shape.normal);
  Nearest found = nearestOnPlane(q, onPlane, -normal, -1);
  if (q.shape.kind == ShapeKind::plane) {
    const Nearest other = nearestOnPlane(q, onPlane, normal, -1);
    if (other.gap > found.gap) found = other;
  }
  return found;
}

Nearest nearestOnShape(ShapeQuery& q, const StartNormal& start) {
  switch (q.shape.kind) {
    case ShapeKind::point:
      return nearestOn(q, PointFeature{q.translation}, start);
    case ShapeKind::segment: {
      const Vector3d axis = q.shape.half * q.rotation.col(2);
      return nearestOnSegment(q, q.translation - axis, q.translation + axis, start);
    }
    case ShapeKind::box:
    case ShapeKind::triangle:
    case ShapeKind::polytope:
      return nearestOnPolytope(q, start);
    case ShapeKind::cylinder:
      return nearestOnCylinder(q, start);
    case ShapeKind::cone:
      return nearestOnCone(q, start);
    case ShapeKind::ellipsoid:
      return nearestOnEllipsoid(q, start);
    case ShapeKind::halfspace:
    case ShapeKind::plane:
      break;
  }
  return nearestOnHalfspace(q);
}

/// The gap along one normal between the two whole cores, and the difference of their support points.
struct Trial {
  Nearest at;
  Vector3d difference;
};

Trial trialAlong(ShapeQuery& q, const Vector3d& n, int hint) {
  const SupportPoint view = viewVolume(q.body, n, hint, q.steps);
  Trial trial;
  trial.at.n = n;
  trial.at.patch = view.patch;
  trial.at.y = q.facing(n);
  trial.at.gap = view.gap(trial.at.y);
  trial.difference = trial.at.y - view.point;
  ++q.pairs;
  return trial;
}

/// The widest gap that bisection found.
struct GapByCuts : LeastOverlap {
  bool overlap = false;  ///< the cores have a common point, beyond rounding
  bool solved = true;    ///< the remaining normals are equal up to rounding
};

/// Bisects the convex cone of remaining normals until only one normal is left, up to rounding. It needs only
/// support points of the two whole bodies (docs/theory.md, 5). Slow, but it cannot fail.
GapByCuts widestGapByCuts(ShapeQuery& q, const StartNormal& start) {
  Trial trial = trialAlong(q, start.n, start.patch);
  GapByCuts best{{trial.at, trial.difference.norm()}};
  if (!(best.bound > q.rounding.gap)) return best;  // touching
  const auto asTrial = [&] { return DirectionTrial{trial.at.n, trial.at.gap, trial.difference}; };
  constexpr auto never = [](const DirectionTrial&) { return false; };
  best.solved = !bisectDirections(
      asTrial(), 0.25 * q.rounding.gap,
      [&](const Vector3d& n) {
        trial = trialAlong(q, n, trial.at.patch);
        best.bound = std::min(best.bound, trial.difference.norm());
        if (trial.at.gap > best.at.gap) best.at = trial.at;
        return asTrial();
      },
      never);
  best.at.apart = best.at.gap > 0.0;
  best.overlap = best.at.gap < -q.rounding.gap;
  return best;
}

struct Solution {
  Nearest at;
  DistanceStatus status;
  double upper;  ///< bound on the cores' gap (m), in addition to the distance of the two points
};

/// Whether a point of the shape is inside a ball that lies in the volume's core.
bool surelyOverlap(const ShapeQuery& q) {
  const double within = q.body.innerRadius() - q.rounding.across;
  return awayFromCentre(q, within).most < within;
}

/// The solution for cores that overlap.
Solution deepSolution(const LeastOverlap& deep) { return {deep.at, DistanceStatus::local, deep.bound}; }

/// A normal along which GJK finds the cores apart. No value if they seem to overlap, for which rounding alone
/// may be the reason.
std::optional<StartNormal> normalBetween(ShapeQuery& q, const StartNormal& start) {
  using Difference = ConvexDifference<StpBvCore, const Shape>;
  constexpr int kSteps = 20;
  StpBvCore core{q.body, start.patch, q.steps};
  Difference difference(core, q.shape, q.pose);
  const auto found = gjk<Difference::Corner>(difference, {}, start.n, q.rounding.across, kSteps,
                                             [](double lower, double) { return lower > 0.0; });
  if (found.verdict == GjkResult<Difference::Corner>::Verdict::overlap) return {};
  return StartNormal{found.n, core.patch};
}

/// Whether to look for a single point of the shape that decides the depth. A small shape nearly always has
/// one and a segment often, other shapes of the volume's size seldom. Each point that is tried needs a pass
/// over all faces.
bool isPointLikely(const ShapeQuery& q) {
  constexpr double kSmall = 0.5;  // of the volume's inner radius: half of these shapes have such a point
  constexpr int kFew = 64;        // faces: up to here a pass costs next to nothing
  return q.shape.reach <= kSmall * q.body.innerRadius() || q.body.faceCount() <= kFew ||
         q.shape.kind == ShapeKind::segment;
}

Solution solve(ShapeQuery& q, const StartNormal& start) {
  constexpr double kNone = kInfinity;
  constexpr int kTries = 12;       // one to five are usual; bodies that overlap take all of them
  constexpr int kMoreTries = 16;   // from a plane between the bodies
  constexpr double kBeyond = 1e3;  // of rounding; a smaller overlap may be a touch
  Nearest found;
  if (q.shape.unbounded()) {
    found = nearestOnShape(q, start);
    return {found, DistanceStatus::exact, found.gap};
  }
  const bool overlap = surelyOverlap(q);
  const WalkEnd end = overlap ? WalkEnd::meeting : walkShapeFeatures(q, start, kTries, found);
  if (end == WalkEnd::nearest) return {found, DistanceStatus::exact, kNone};
  const std::optional<StartNormal> between = end == WalkEnd::meeting ? std::nullopt : normalBetween(q, start);
  if (between) {
    if (walkShapeFeatures(q, *between, kMoreTries, found) == WalkEnd::nearest)
      return {found, DistanceStatus::exact, kNone};
  } else {
    if (isPointLikely(q))
      if (const auto deep = overlapOfPoint(q, start)) return deepSolution(*deep);
    if (const auto deep = overlapOfCones(q)) return deepSolution(*deep);
    const LeastOverlap deep = leastOverlap(q, start);
    if (overlap || deep.at.gap < -kBeyond * q.rounding.across) return deepSolution(deep);
  }
  found = nearestOnShape(q, start);
  if (certified(q, found)) return {found, DistanceStatus::exact, kNone};
  const GapByCuts cuts = widestGapByCuts(q, found.apart ? StartNormal{found.n, found.patch} : start);
  if (cuts.overlap) return deepSolution(leastOverlap(q, {cuts.at.n, cuts.at.patch}));
  // This is near the answer. A feature search from here gives the last digits.
  found = nearestOnShape(q, {cuts.at.n, cuts.at.patch});
  if (certified(q, found)) return {found, DistanceStatus::exact, kNone};
  // Either both bounds agree, or no remaining normal can have a wider gap.
  const double upper = cuts.solved ? std::min(cuts.bound, cuts.at.gap + q.rounding.gap) : cuts.bound;
  const bool proven = upper - cuts.at.gap <= q.rounding.gap;
  // If the cores touch, the gradient of the gap determines the normal better than the gap itself.
  const std::optional<DeepFeature> touching = touchingFeature(q, cuts.at);
  found = touching ? touching->at : cuts.at;
  return {found, proven ? DistanceStatus::exact : DistanceStatus::bounded, upper + q.rounding.across};
}

/// Distance of the shape's point from the point opposite the volume's point (m). For a face, a generator or
/// an axis, and if an ulp of the normal moves the point a long way, the search may have found another point
/// of the feature. Then this takes the shape's nearest point instead.
double placeOpposite(const ShapeQuery& q, const Vector3d& point, Nearest& found) {
  const Vector3d opposite = point + found.gap * found.n;
  const double beside = (found.y - opposite).norm();
  if (beside <= 2.0 * q.rounding.across || q.shape.unbounded()) return beside;
  const Vector3d nearest = q.pose.placed(ontoCore(q.shape, q.pose.inSecond(opposite)));
  if (!((nearest - opposite).norm() < beside)) return beside;
  found.y = nearest;
  return (nearest - opposite).norm();
}

}  // namespace

Distance distance(const StpBv& volume, const Isometry3d& poseVolume, const Shape& shape,
                  const Isometry3d& poseShape, PairCache* cache) {
  Distance result;
  const RelativePose pose = relativePose(poseVolume, poseShape);
  if (!shape.valid() || !pose.valid) return result;

  ShapeQuery q(volume, shape, pose);
  Solution found = solve(q, startOf(q, cache ? *cache : PairCache{}));

  Nearest& x = found.at;
  const double margins = volume.radii().r + shape.margin;
  const SupportPoint view = viewVolume(volume, x.n, x.patch, q.steps);
  // Two points of the cores. A normal is accurate to an ulp, so they may lie slightly beside their bodies.
  const Vector3d known = x.y;
  const double beside = placeOpposite(q, view.point, x);
  if (found.status != DistanceStatus::local)
    found.upper = std::min(found.upper, std::hypot(x.gap, beside + q.rounding.across));
  else if (!(x.n.dot(x.y - known) <= q.rounding.gap))
    x.y = known;  // the other one leaves sooner
  result.status = found.status;
  result.distance = x.gap - margins;
  result.lower = result.distance - q.rounding.certificate;
  result.upper = std::max(found.upper, x.gap) - margins + 2.0 * q.rounding.certificate;
  result.patch = {view.patch, -1};
  result.normal = pose.normalInWorld(x.n);
  result.point[0] = pose.inWorld(view.point + volume.radii().r * x.n);
  result.point[1] = pose.inWorld(x.y - shape.margin * x.n);
  result.patchPairs = q.pairs;
  result.patchSteps = q.steps;
  if (cache) {
    cache->normal = result.normal;
    cache->patch = result.patch;
  }
  return result;
}

Distance distance(const Shape& shape, const Isometry3d& poseShape, const StpBv& volume,
                  const Isometry3d& poseVolume, PairCache* cache) {
  // The same query, and so the same answer, seen from the other side.
  PairCache mirrored;
  if (cache) mirrored = cache->mirrored();
  const Distance result =
      distance(volume, poseVolume, shape, poseShape, cache ? &mirrored : nullptr).mirrored();
  if (cache) *cache = mirrored.mirrored();
  return result;
}

Distance distance(const StpBv& volume, const Isometry3d& pose, const Vector3d& point, PairCache* cache) {
  Isometry3d at = pose;  // its rotation is no matter, and relative coordinates stay exact
  at.translation() = point;
  return distance(volume, pose, Shape::sphere(0.0), at, cache);
}

}  // namespace fcl_stpbv
