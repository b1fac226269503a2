// Andrew's monotone chain (1979): the points from left to right give the
// lower side, back again the upper one.
#include "fcl_stpbv/posture/convex_polygon.h"

#include <algorithm>

namespace fcl_stpbv::detail {

using Eigen::Vector2d;

std::vector<Vector2d> convexPolygon(std::vector<Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const Vector2d& a, const Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  std::vector<Vector2d> corners;
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = corners.size();
    for (const Vector2d& p : points) {
      while (corners.size() >= first + 2 &&
             cross(corners.back() - corners[corners.size() - 2], p - corners.back()) <= 0)
        corners.pop_back();
      corners.push_back(p);
    }
    if (!corners.empty()) corners.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return corners;
}

}  // namespace fcl_stpbv::detail
