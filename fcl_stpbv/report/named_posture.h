// A posture that the user names: a state of the SRDF, or a file of joint values.
#pragma once

#include <string>

#include "fcl_stpbv/robot/kinematics.h"

namespace fcl_stpbv::report {

/// The configuration that `name` stands for: a JSON file of joints and their values, or of a list of all
/// coordinates; else a group_state of `srdf` (null for none). `option` is the argument that asks for it.
/// @throws Error naming the file or the argument, and what would work.
Eigen::VectorXd namedPosture(const std::string& option, const std::string& name, const Kinematics& kinematics,
                             const Srdf* srdf);

}  // namespace fcl_stpbv::report
