// Andrew's monotone chain (1979): a pass over the points from left to right gives the lower side, a pass back
// gives the upper side.
#include "fcl_stpbv/volume/convex_polygon.h"

#include <algorithm>
#include <numeric>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

using Eigen::Vector2d;

std::vector<int> convexPolygon(const std::vector<Vector2d>& points, double tolerance) {
  std::vector<int> order(points.size()), corners;
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    const Vector2d &p = points[at(i)], &q = points[at(j)];
    return p.x() != q.x() ? p.x() < q.x() : p.y() < q.y();
  });
  for (int side = 0; side < 2; ++side) {
    const std::size_t first = corners.size();
    for (const int next : order) {
      while (corners.size() >= first + 2) {
        const Vector2d& before = points[at(corners[corners.size() - 2])];
        const Vector2d chord = points[at(next)] - before;
        if (cross(points[at(corners.back())] - before, chord) > tolerance * chord.norm()) break;
        corners.pop_back();
      }
      corners.push_back(next);
    }
    if (!corners.empty()) corners.pop_back();
    std::reverse(order.begin(), order.end());
  }
  return corners;
}

}  // namespace fcl_stpbv::detail
