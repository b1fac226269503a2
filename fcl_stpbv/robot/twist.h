// The velocity of a rigid body's points.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "fcl_stpbv/robot/kinematics.h"

namespace fcl_stpbv::detail {

/// Velocity of the body's point that is at `x`.
inline Eigen::Vector3d velocityOf(const Eigen::Vector3d& x, const Twist& body) {
  return body.linear + body.angular.cross(x);
}

/// [linear; angular] as one vector; the two lie in memory in this order.
inline Eigen::Map<const Eigen::Matrix<double, 6, 1>> stacked(const Twist& body) {
  static_assert(sizeof(Twist) == 6 * sizeof(double));
  return Eigen::Map<const Eigen::Matrix<double, 6, 1>>(body.linear.data());
}

}  // namespace fcl_stpbv::detail
