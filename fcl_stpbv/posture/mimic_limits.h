// Converts the limits of mimic joints to limits of the joints that they follow.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/robot/kinematics.h"

namespace fcl_stpbv::detail {

/// Limits of the coordinates, and for each the name of the mimic joint that determines it; "" if it is the
/// joint's own limit.
struct NamedLimits {
  Eigen::VectorXd& values;
  std::vector<std::string>& by;
};

/// Narrows the limits of coordinates so that the joints which follow them keep their own limits. For a
/// continuous joint, the range of one turn is shifted to where its followers allow it.
/// @throws Error naming the joints if no value is left.
void keepMimicLimits(const Kinematics& kinematics, NamedLimits lower, NamedLimits upper);

/// A warning if the limits of mimic joints leave no posture, so that everything said about the robot is about
/// postures that it cannot have; else none.
std::vector<std::string> impossibleMimics(const Kinematics& kinematics);

}  // namespace fcl_stpbv::detail
