// Finds joints and links by the names in an example. If the robot has no such name, the error names it.
#pragma once

#include <string>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/kinematics.h"

/// The joint's index in q. @throws fcl_stpbv::Error if the robot has no joint of this name with a coordinate.
inline int coordinateOf(const fcl_stpbv::Kinematics& kinematics, const std::string& joint) {
  const int k = kinematics.coordinate(joint);
  if (k < 0)
    throw fcl_stpbv::Error(kinematics.robot().path + ": has no joint '" + joint +
                           "' of its own coordinate; put a joint of this robot into the example");
  return k;
}

/// The link's index. @throws fcl_stpbv::Error if the robot has no link of this name.
inline int linkOf(const fcl_stpbv::RobotModel& robot, const std::string& link) {
  const int i = robot.link(link);
  if (i < 0)
    throw fcl_stpbv::Error(robot.path + ": has no link '" + link +
                           "'; put a link of this robot into the example");
  return i;
}
