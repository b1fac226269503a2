// The smallest ball around a cloud. `R - r` of an STP-BV must be larger than its radius.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fcl_stpbv::detail {

struct Ball {
  Eigen::Vector3d centre{0, 0, 0};
  double radius = 0;
};

/// Minimum enclosing ball of a non-empty cloud, to rounding (m).
Ball minimumEnclosingBall(const std::vector<Eigen::Vector3d>& points);

}  // namespace fcl_stpbv::detail
