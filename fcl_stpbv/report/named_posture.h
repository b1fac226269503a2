// Reads a posture that the user names: a state of the SRDF, or a file of joint values.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/robot/kinematics.h"

namespace fcl_stpbv::report {

/// The configuration that `name` stands for. It may be a JSON file: joints, or coordinates such as `j/x`, and
/// their values; or a list of all coordinates; or an answer of find_posture. Otherwise it is a group_state of
/// `srdf` (null for none). Joints that are not named stay as in `rest`. `option` is the argument that asks
/// for the posture. With `obstacles` the base has to stay where the URDF places it.
/// @throws Error naming the file or the argument, and what would work.
Eigen::VectorXd namedPosture(const std::string& option, const std::string& name, const Kinematics& kinematics,
                             const Srdf* srdf, const Eigen::VectorXd& rest, bool obstacles);

/// A warning with its `consequence` if coordinates in one of `postures` are beyond their joints' limits;
/// otherwise "". `name` is the source of the postures.
std::string limitWarning(const std::string& name, const std::vector<Eigen::VectorXd>& postures,
                         const Kinematics& kinematics, const std::string& consequence);

}  // namespace fcl_stpbv::report
