// Points in an order in which neighbours in space are mostly near each other in memory.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fcl_stpbv::detail {

/// Indices of the points along Morton's curve through their bounding box. Of several equal points only the
/// first one is included.
std::vector<int> spaceOrder(const std::vector<Eigen::Vector3d>& points);

}  // namespace fcl_stpbv::detail
