// Reads a posture that the user names: a state of the SRDF, or a file of joint values.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/robot/kinematics.h"

namespace fcl_stpbv::report {

/// The configuration that `name` stands for: a JSON file of joints, or coordinates such as `j/x`, and their
/// values, or a list of all coordinates, or an answer of find_posture; else a group_state of `srdf` (null
/// for none). Joints that it does not name are as in `rest`. `option` is the argument that asks for it. With
/// `obstacles` the base has to stay where the URDF has it.
/// @throws Error naming the file or the argument, and what would work.
Eigen::VectorXd namedPosture(const std::string& option, const std::string& name, const Kinematics& kinematics,
                             const Srdf* srdf, const Eigen::VectorXd& rest, bool obstacles);

/// A warning where coordinates leave their joints' limits in one of `postures`, which `name` gave, and the
/// `consequence` of that; else "".
std::string limitWarning(const std::string& name, const std::vector<Eigen::VectorXd>& postures,
                         const Kinematics& kinematics, const std::string& consequence);

}  // namespace fcl_stpbv::report
