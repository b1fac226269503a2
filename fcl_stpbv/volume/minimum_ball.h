// The smallest ball around a cloud: its radius is the least `R - r` an STP-BV can have.
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
