// The state of a cloud during the roll, and the merging of points that are close together.
#include "fcl_stpbv/volume/rolling_cloud.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

double extentOf(const std::vector<Vector3d>& points) {
  Vector3d low = points[0], high = points[0];
  for (const Vector3d& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return (high - low).norm();
}

RollingCloud::RollingCloud(const std::vector<Vector3d>& cloud, double ballRadius)
    : points(cloud),
      radius(ballRadius),
      curvature(std::isinf(radius) ? 0 : 1 / radius),
      extent(extentOf(points)),
      tree(points),
      same_(touchTolerance(points)),
      isVertex_(points.size(), 0) {}

void RollingCloud::removeTwins(int i) {
  std::vector<int> twins;
  tree.within(at(i), same_, &twins);
  for (const int j : twins)
    if (j != i) tree.remove(j);
}

bool RollingCloud::claim(const Ring& ring) {
  for (const int i : ring) {
    if (tree.isRemoved(i)) return false;
    if (isVertex_[static_cast<std::size_t>(i)]) continue;
    removeTwins(i);
    isVertex_[static_cast<std::size_t>(i)] = 1;
  }
  return true;
}

}  // namespace fcl_stpbv::detail
