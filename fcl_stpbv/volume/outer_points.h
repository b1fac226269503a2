// The points of a large cloud that may be vertices of its hull.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fcl_stpbv::detail {

/// Indices, ascending, of all points but those that are inside the others' convex hull by more than a
/// millionth of the largest coordinate: of a million points spread through a box an eighth is left. All of a
/// small cloud, and of one that is a surface.
std::vector<int> outerPoints(const std::vector<Eigen::Vector3d>& points);

}  // namespace fcl_stpbv::detail
