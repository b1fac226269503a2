// What a rigid body's velocity does to its points.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "fcl_stpbv/robot/kinematics.h"

namespace fcl_stpbv::detail {

/// Velocity of the body's point that is at `x`.
inline Eigen::Vector3d velocityOf(const Eigen::Vector3d& x, const Twist& body) {
  return body.linear + body.angular.cross(x);
}

}  // namespace fcl_stpbv::detail
