// The size of a robot and its obstacles, and from it the range in which coordinates without limits are
// searched.
#pragma once

#include <vector>

#include "fcl_stpbv/robot/checked_pairs.h"

namespace fcl_stpbv::detail {

/// How far a link's bodies reach from its origin (m).
double reachOf(const RobotGeometry& geometry, int link);

/// The longest way from the parent's origin to the child's, within the limits (m). Of a planar or floating
/// joint, which has none, where it stands at zero.
double lengthOf(const RobotModel& robot, int joint);

/// Coordinates that translate without limits (of planar and floating joints and of a moving base) are
/// searched up to this distance in both directions (m). If two bodies can meet at all, they meet within it,
/// without changes of the other joints. At least 1 m.
double searchRoom(const RobotModel& robot, const RobotGeometry& geometry,
                  const std::vector<Obstacle>& obstacles);

}  // namespace fcl_stpbv::detail
