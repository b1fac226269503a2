// Bounds from both sides, the cheapest first:
// 1. Balls around the volumes apart, or balls inside them near each other.
// 2. The plane across the line of centres between the volumes.
// 3. GJK on the vertices: hulls with a common point put the volumes as deep in each other as their margins
// are thick;
//    hulls apart give a plane.
// 4. The exact distance, from that plane's normal.
#include "fcl_stpbv/distance/threshold.h"

#include <cmath>

#include "fcl_stpbv/distance/body_pair.h"
#include "fcl_stpbv/distance/vertex_gjk.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {

using Eigen::Isometry3d;
using Eigen::Vector3d;

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
  if (length - a.innerRadius() - b.innerRadius() - pair.margins() <= x) return false;  // no plane is
  const Packed last = pose.toWorld.inverse(pack(cache.normal));
  const double length2 = dot(last, last);
  if (!(length2 > 0.25 && length2 < 4.0)) return false;
  int ignored = 0;
  // From the tables: the cache's patches may be far off by now.
  const Sample plane = pair.sampleFrom(unpack(last / std::sqrt(length2)), {-1, -1}, ignored);
  return plane.core - pair.margins() - rounding > x;
}

FCL_STPBV_VECTORIZED
bool isFartherThan(double x, const StpBv& a, const Isometry3d& poseA, const StpBv& b, const Isometry3d& poseB,
                   PairCache* cache) {
  const RelativePose pose(poseA, poseB);
  if (!pose.valid) return false;
  const detail::BodyPair pair(a, b, pose);
  const double rounding = pair.certificateRounding(), margins = pair.margins();
  const Vector3d between = unpack(pair.centreDifference());
  const double length = between.norm();
  if (length - a.enclosingRadius() - b.enclosingRadius() - rounding > x) return true;
  if (length - a.innerRadius() - b.innerRadius() - margins + rounding <= x) return false;

  int ignored = 0;
  const auto isPlaneBetween = [&](const detail::Sample& s) { return s.core - margins - rounding > x; };
  const Vector3d n = length > 0 ? Vector3d(between / length) : Vector3d::UnitX();
  detail::Sample plane = pair.sampleFrom(n, pair.near(n), ignored);
  if (isPlaneBetween(plane)) return true;
  constexpr double kShared = 1e-11;  // m, over what vertexGjk() takes for a common point
  const detail::VertexGjk hulls = detail::vertexGjk(pair, n);
  if (!hulls.apart && x >= kShared - margins) return false;
  if (hulls.apart) plane = pair.sampleFrom(hulls.n, hulls.vertex, ignored);
  if (isPlaneBetween(plane)) return true;

  PairCache start{pose.normalInWorld(plane.n), plane.patch};
  const Distance found = distance(a, poseA, b, poseB, &start);
  if (cache) *cache = start;
  return found.status != DistanceStatus::invalid && found.lower > x;
}

}  // namespace fcl_stpbv::detail
