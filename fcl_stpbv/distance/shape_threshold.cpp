// Is an STP-BV farther from a simple shape than a threshold? Bounds from both sides, the cheapest first:
// 1. The plane of the remembered normal, or across the line of centres, between the two.
// 2. GJK on the cores, until a plane is far enough from both, two points of theirs are near enough, or the
//    cores turn out to overlap.
// 3. The exact distance, from the best plane: next to the threshold, and where the bodies have to be deep in
//    each other.
#include "fcl_stpbv/convex/gjk.h"
#include "fcl_stpbv/convex/support.h"
#include "fcl_stpbv/distance/shape_distance.h"
#include "fcl_stpbv/distance/shape_query.h"
#include "fcl_stpbv/distance/threshold.h"

namespace fcl_stpbv::detail {

using Eigen::Isometry3d;
using Eigen::Vector3d;

bool isFartherThan(double x, const StpBv& volume, const Isometry3d& poseVolume, const Shape& shape,
                   const Isometry3d& poseShape, PairCache* cache) {
  using Difference = ConvexDifference<StpBvCore, const Shape>;
  const RelativePose pose(poseVolume, poseShape);
  if (!shape.valid() || !pose.valid) return false;
  PairCache start;
  if (cache) start = *cache;
  const auto isDistanceFarther = [&] {
    const Distance found = distance(volume, poseVolume, shape, poseShape, &start);
    if (cache) *cache = start;
    return found.lower > x;
  };
  const ShapeQuery q(volume, shape, pose);
  const double level = x + volume.radii().r + shape.margin, unsure = q.rounding.gap + q.rounding.across;
  if (shape.unbounded() || !(level > unsure)) return isDistanceFarther();

  const Vector3d last = pose.toWorld.inverse(start.direction()),
                 centres = q.posed(shape.centre) - volume.centre();
  const bool isKnown = !last.isZero(0);
  const Vector3d n = isKnown             ? last.normalized()
                     : centres.isZero(0) ? Vector3d(1, 0, 0)
                                         : centres.normalized();
  int ignored = 0;
  StpBvCore core{volume, isKnown && start.patch[0] < volume.patchCount() ? start.patch[0] : -1, ignored};
  Difference difference(core, shape, pose);
  constexpr int kSteps = 40;
  const double above = level + q.rounding.certificate;
  const auto found = gjk<Difference::Corner>(
      difference, {}, n, q.rounding.gap, kSteps,
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
