// Threshold test of an STP-BV and a simple shape. It uses lower and upper bounds, the cheapest first:
// 1. How far the shape is from the centre of the balls around and inside the volume.
// 2. A feature walk of a few steps to the distance (shape_walk.cpp).
// 3. GJK on the cores, until a plane is far enough from both, two points of theirs are near enough, or the
//    cores turn out to overlap.
// 4. The exact distance, from the best plane: if the distance is close to the threshold, or if the threshold
//    is so deep that the cores touch or overlap there.
#include "fcl_stpbv/convex/gjk.h"
#include "fcl_stpbv/convex/support.h"
#include "fcl_stpbv/distance/shape_distance.h"
#include "fcl_stpbv/distance/shape_query.h"
#include "fcl_stpbv/distance/threshold.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {

using Eigen::Isometry3d;
using Eigen::Vector3d;

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
