// The limits of joints that mimic others, as limits of the joints that they follow.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/robot/kinematics.h"

namespace fcl_stpbv::detail {

/// Limits of the coordinates, and for each the mimic joint that sets it, "" where it is the joint's own.
struct NamedLimits {
  Eigen::VectorXd& values;
  std::vector<std::string>& by;
};

/// Narrows the limits of coordinates so that the joints which follow them keep to theirs. A continuous
/// joint's turn is moved to where its followers allow it.
/// @throws Error naming the joints where nothing is left.
void keepMimicLimits(const Kinematics& kinematics, NamedLimits lower, NamedLimits upper);

}  // namespace fcl_stpbv::detail
