// How many coordinates a joint has, and the plane that it moves in.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv::detail {

/// Number of coordinates of a joint that mimics no other joint: 0, 1, 3 or 6.
inline int freedoms(JointType type) {
  switch (type) {
    case JointType::fixed:
      return 0;
    case JointType::planar:
      return 3;
    case JointType::floating:
      return 6;
    default:
      return 1;
  }
}

/// The frame of the plane in which a planar joint moves: its z axis is the joint's axis, and it is turned
/// from the link's frame by the smallest angle. The x and y axes of the plane are the first two columns.
inline Eigen::Matrix3d planeAcross(const Eigen::Vector3d& axis) {
  const Eigen::Vector3d across = Eigen::Vector3d::UnitZ().cross(axis);
  const Eigen::Vector3d turn =
      across.norm() > 0 ? Eigen::Vector3d(across.stableNormalized()) : Eigen::Vector3d::UnitX();
  return Eigen::AngleAxisd(std::atan2(across.norm(), axis.z()), turn).toRotationMatrix();
}

}  // namespace fcl_stpbv::detail
