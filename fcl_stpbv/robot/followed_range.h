// The range of continuous joints that others follow.
#pragma once

#include <vector>

#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv::detail {

/// Larger than any robot (m, rad): beyond it are slips of units and exponents, which would put links where no
/// distance can be computed.
constexpr double kLargestValue = 1e6;

/// Widens a continuous joint's limits to all that its followers do. Half a turn either way is all of itself,
/// but not of what follows it at another speed: a wheel at half of it takes two turns, a rack as many as its
/// limits leave room for.
void widenFollowed(std::vector<JointModel>& joints);

}  // namespace fcl_stpbv::detail
