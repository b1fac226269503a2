// The names by which a user may mean a joint's value.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "fcl_stpbv/robot/kinematics.h"

namespace fcl_stpbv::detail {

/// The names of all coordinates, then the names of moving joints that have another name or follow another
/// joint.
inline std::vector<std::string> valueNames(const Kinematics& kinematics) {
  std::vector<std::string> names = kinematics.names();
  for (const JointModel& joint : kinematics.robot().joints)
    if (joint.type != JointType::fixed && std::find(names.begin(), names.end(), joint.name) == names.end())
      names.push_back(joint.name);
  return names;
}

}  // namespace fcl_stpbv::detail
