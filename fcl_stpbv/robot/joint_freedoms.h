// How many coordinates a joint has, and the plane that it moves in.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv::detail {

/// Of its own, were it to mimic no other: 0, 1, 3 or 6.
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

/// The plane a planar joint moves in: the frame whose z axis is the joint's, turned from the link's frame by
/// the smallest angle. Its x and y axes are the first two columns.
inline Eigen::Matrix3d planeAcross(const Eigen::Vector3d& axis) {
  const Eigen::Vector3d across = Eigen::Vector3d::UnitZ().cross(axis);
  const Eigen::Vector3d turn =
      across.norm() > 0 ? Eigen::Vector3d(across.stableNormalized()) : Eigen::Vector3d::UnitX();
  return Eigen::AngleAxisd(std::atan2(across.norm(), axis.z()), turn).toRotationMatrix();
}

}  // namespace fcl_stpbv::detail
