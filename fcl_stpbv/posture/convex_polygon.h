// Convex polygons in the plane.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fcl_stpbv::detail {

/// Of two vectors: above 0 where `b` points to the left of `a`.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Corners of the convex hull, counter-clockwise, none on an edge.
std::vector<Eigen::Vector2d> convexPolygon(std::vector<Eigen::Vector2d> points);

}  // namespace fcl_stpbv::detail
