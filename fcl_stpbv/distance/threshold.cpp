// Threshold tests. They use lower and upper bounds, the cheapest first. Of two STP-BVs:
// 1. The distance of balls around the volumes, and of balls inside them.
// 2. If the last separating plane is cached and the bodies have hardly turned: the exact distance, which
//    takes only a step or two from there, unless the cores overlap along that plane.
// 3. A plane perpendicular to the line of centres.
// 4. GJK on the vertices, until two points of the cores are so near that the volumes must be within the
//    threshold, or until a plane separates the hulls.
// 5. The exact distance, from that plane's normal.
//
// Of an STP-BV and a simple shape:
// 1. How far the shape is from the centre of the balls around and inside the volume.
// 2. A feature walk of a few steps to the distance (shape_walk.cpp).
// 3. GJK on the cores, until a plane is far enough from both, two points of theirs are near enough, or the
//    cores turn out to overlap.
// 4. The exact distance, from the best plane: if the distance is close to the threshold, or if the threshold
//    is so deep that the cores touch or overlap there.
#include "fcl_stpbv/distance/threshold.h"

#include <cmath>

#include "fcl_stpbv/convex/gjk.h"
#include "fcl_stpbv/convex/support.h"
#include "fcl_stpbv/distance/body_pair.h"
#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/distance/shape_query.h"
#include "fcl_stpbv/distance/vertex_gjk.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

/// Whether the pair's last normal has hardly turned in the frames of both bodies.
bool isRecent(const PairCache& cache, const BodyPair& pair, const RelativePose& pose) {
  constexpr double kTurn =
      0.1;  // rad; after a larger turn, a search from the line of centres takes fewer steps
  const Vector3d n = pose.toWorld.inverse(cache.normal);
  const auto turned = [](const Vector3d& now, const Eigen::Vector3f& then) {
    return (now - then.cast<double>()).squaredNorm();
  };
  return PairCache::isDirection(n.squaredNorm()) && turned(n, cache.seen[0]) < kTurn * kTurn &&
         turned(pair.opposite(n), cache.seen[1]) < kTurn * kTurn;
}

}  // namespace

FCL_STPBV_VECTORIZED
bool isFartherByBounds(double x, const StpBv& a, const Isometry3d& poseA, const StpBv& b,
                       const Isometry3d& poseB, const PairCache& cache) {
  const RelativePose pose(poseA, poseB);
  if (!pose.valid) return false;
  const BodyPair pair(a, b, pose);
  const double rounding = pair.certificateRounding();
  const Packed between = pair.centreDifference();
  const double length = std::sqrt(dot(between, between));
  if (length - a.enclosingRadius() - b.enclosingRadius() - rounding > x) return true;
  if (length - a.innerRadius() - b.innerRadius() - pair.margins() <= x)
    return false;  // no plane can separate by more
  const Packed last = pose.toWorld.inverse(pack(cache.normal));
  const double length2 = dot(last, last);
  if (!PairCache::isDirection(length2)) return false;
  int ignored = 0;
  // The owners are looked up in the tables, because the cache's patches may be far away by now.
  const Sample plane = pair.sampleFrom(unpack(last / std::sqrt(length2)), {-1, -1}, ignored);
  return plane.core - pair.margins() - rounding > x;
}

FCL_STPBV_VECTORIZED
bool isFartherThan(double x, const StpBv& a, const Isometry3d& poseA, const StpBv& b, const Isometry3d& poseB,
                   PairCache* cache) {
  const RelativePose pose(poseA, poseB);
  if (!pose.valid) return false;
  const BodyPair pair(a, b, pose);
  const double rounding = pair.certificateRounding(), margins = pair.margins();
  const Vector3d between = unpack(pair.centreDifference());
  const double length = between.norm();
  if (length - a.enclosingRadius() - b.enclosingRadius() - rounding > x) return true;
  if (length - a.innerRadius() - b.innerRadius() - margins + rounding <= x) return false;

  const auto isDistanceFarther = [&](PairCache* start) {
    const Distance found = distance(a, poseA, b, poseB, start);
    return found.status != DistanceStatus::invalid && found.lower > x;
  };
  int ignored = 0;
  const auto isPlaneBetween = [&](const Sample& s) {
    if (!(s.core - margins - rounding > x)) return false;
    if (cache)
      *cache = {pose.normalInWorld(s.n), s.patch, {s.n.cast<float>(), pair.opposite(s.n).cast<float>()}};
    return true;
  };
  if (cache && isRecent(*cache, pair, pose)) {
    const auto known = [](const StpBv& body, int patch) { return patch < body.patchCount() ? patch : -1; };
    const Sample last = pair.sampleFrom(pose.toWorld.inverse(cache->normal).normalized(),
                                        {known(a, cache->patch[0]), known(b, cache->patch[1])}, ignored);
    if (last.core > 0) return isDistanceFarther(cache);  // also stores the best plane for the next query
  }
  const Vector3d n = length > 0 ? Vector3d(between / length) : Vector3d::UnitX();
  Sample plane = pair.sampleFrom(n, {-1, -1}, ignored);
  if (isPlaneBetween(plane)) return true;
  constexpr double kShared = 1e-11;  // m; more than the rounding at which vertexGjk() reports a common point
  const double level = x + margins;
  const VertexGjk hulls = vertexGjk(pair, n, level);
  if (hulls.nearest <= level - kShared) return false;
  if (hulls.apart) plane = pair.sampleFrom(hulls.n, hulls.vertex, ignored);
  if (isPlaneBetween(plane)) return true;

  PairCache start{pose.normalInWorld(plane.n), plane.patch};
  const bool farther = isDistanceFarther(&start);
  if (cache) *cache = start;
  return farther;
}

FCL_STPBV_VECTORIZED
bool isFartherByBounds(double x, const StpBv& volume, const Isometry3d& poseVolume, const Shape& shape,
                       const Isometry3d& poseShape, const PairCache& cache) {
  const RelativePose pose(poseVolume, poseShape);
  if (!shape.valid() || !pose.valid) return false;
  const ShapeQuery q(volume, shape, pose);
  const double around = volume.enclosingRadius() + shape.margin + q.rounding.certificate;
  if (awayFromCentre(q, -kInfinity).least > x + around) return true;
  const Vector3d last = pose.toWorld.inverse(cache.direction());
  if (last.isZero(0) || shape.unbounded()) return false;
  int ignored = 0;
  const Vector3d n = last.normalized();
  const double gap = viewVolume(volume, n, -1, ignored).gap(q.facing(n));
  return gap - volume.radii().r - shape.margin - q.rounding.certificate > x;
}

bool isFartherThan(double x, const StpBv& volume, const Isometry3d& poseVolume, const Shape& shape,
                   const Isometry3d& poseShape, PairCache* cache) {
  using Difference = ConvexDifference<StpBvCore, const Shape>;
  const RelativePose pose = relativePose(poseVolume, poseShape);
  if (!shape.valid() || !pose.valid) return false;
  PairCache start;
  if (cache) start = *cache;
  const auto isDistanceFarther = [&] {
    const Distance found = distance(volume, poseVolume, shape, poseShape, &start);
    if (cache) *cache = start;
    return found.lower > x;
  };
  ShapeQuery q(volume, shape, pose);
  const double margins = volume.radii().r + shape.margin, rounding = q.rounding.certificate;
  const double beyond = x + volume.enclosingRadius() + shape.margin + rounding;
  const Span away = awayFromCentre(q, beyond);
  if (away.least > beyond) return true;
  if (away.most - volume.innerRadius() - margins + rounding <= x) return false;
  if (shape.unbounded()) return isDistanceFarther();

  const StartNormal from = startOf(q, start);
  constexpr int kTries = 5;  // enough for most pairs that are apart
  Nearest nearest;
  const bool maybeApart = away.most > 0.5 * (volume.innerRadius() + volume.enclosingRadius());
  const WalkEnd end = maybeApart ? walkShapeFeatures(q, from, kTries, nearest) : WalkEnd::unknown;
  if (end == WalkEnd::nearest) {
    if (cache) *cache = {pose.normalInWorld(nearest.n), {nearest.patch, -1}};
    return nearest.gap - margins - rounding > x;
  }
  const double level = x + margins, unsure = q.rounding.gap + q.rounding.across;
  if (!(level > unsure)) return isDistanceFarther();
  if (end == WalkEnd::meeting) return false;
  int ignored = 0;
  StpBvCore core{volume, from.patch, ignored};
  Difference difference(core, shape, pose);
  constexpr int kSteps = 40;
  const double above = level + rounding;
  const auto found = gjk<Difference::Corner>(
      difference, {}, from.n, q.rounding.gap, kSteps,
      [&](double lower, double upper) { return lower > above || upper + unsure <= level; });
  if (found.lower > above) {
    if (cache) *cache = {pose.normalInWorld(found.widest), {core.patch, -1}};
    return true;
  }
  if (found.verdict == GjkResult<Difference::Corner>::Verdict::overlap || found.upper + unsure <= level)
    return false;
  start = {pose.normalInWorld(found.n), {core.patch, -1}};
  return isDistanceFarther();
}

}  // namespace fcl_stpbv::detail
