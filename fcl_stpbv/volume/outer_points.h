// The points of a large cloud that may be vertices of its hull.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fcl_stpbv::detail {

/// Ascending indices of the points that remain after removing points well inside: a point may be removed only
/// if it is inside the others' convex hull by more than a millionth of the largest coordinate. Of a million
/// points spread through a box an eighth is left. Small clouds, and clouds that are a surface, keep all
/// points.
std::vector<int> outerPoints(const std::vector<Eigen::Vector3d>& points);

}  // namespace fcl_stpbv::detail
