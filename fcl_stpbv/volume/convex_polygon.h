// Convex polygons in the plane.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fcl_stpbv::detail {

/// Of two vectors: above 0 where `b` points to the left of `a`.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Corners of the convex hull, counter-clockwise from the leftmost one, as indices into `points`; none on an
/// edge, and none that stands out by no more than `tolerance` from the chord of those beside it.
std::vector<int> convexPolygon(const std::vector<Eigen::Vector2d>& points, double tolerance = 0);

}  // namespace fcl_stpbv::detail
