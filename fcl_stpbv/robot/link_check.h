// Checks a link that a caller names by its index.
#pragma once

#include <string>

#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv::detail {

/// @throws Error naming `owner` and the link, if the robot has no link of this index.
inline void requireLink(const std::string& owner, int link, const RobotModel& robot) {
  if (link < 0 || static_cast<std::size_t>(link) >= robot.links.size())
    throw Error(owner + ": there is no link " + std::to_string(link) + " of " +
                std::to_string(robot.links.size()));
}

}  // namespace fcl_stpbv::detail
