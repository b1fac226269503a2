// Convex polygons in the plane.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fcl_stpbv::detail {

/// Cross product of two vectors: above 0 if `b` points to the left of `a`.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Corners of the convex hull, counter-clockwise from the leftmost one, as indices into `points`. A point on
/// an edge is no corner. Neither is a point that is at most `tolerance` outside the chord between its
/// neighbours.
std::vector<int> convexPolygon(const std::vector<Eigen::Vector2d>& points, double tolerance = 0);

}  // namespace fcl_stpbv::detail
