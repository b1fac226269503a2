// The range of continuous joints that other joints mimic.
#pragma once

#include <vector>

#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv::detail {

/// Limit on values (m, rad), larger than those of any robot. Larger values are errors of units or exponents,
/// and would move links so far away that no distance can be computed.
constexpr double kLargestValue = 1e6;

/// Widens the limits of a continuous joint to the whole range of the joints that mimic it. Half a turn in
/// both directions is the full range of the joint itself, but not of a joint that follows with another
/// multiplier. A wheel with multiplier 1/2 needs two turns of the leader. If prismatic joints follow, the
/// leader goes as far as the limits of all of these allow, and not farther for other followers.
void widenFollowed(std::vector<JointModel>& joints);

}  // namespace fcl_stpbv::detail
