// The joints between two links of a robot's tree.
#pragma once

#include <cstddef>
#include <vector>

#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv::detail {

/// The joints from one link up to where the ways to the root meet, then down to the other link. Fixed joints
/// are included.
struct JointPath {
  std::vector<int> joints;
  /// This many at the front are passed from child to parent, the others from parent to child.
  std::size_t up = 0;
};

JointPath jointPath(const RobotModel& robot, int link1, int link2);

}  // namespace fcl_stpbv::detail
