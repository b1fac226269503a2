// What is known about a pair in one configuration: distance, gradient, over-covers.
#pragma once

#include <vector>

#include "fcl_stpbv/report/collision_report.h"

namespace fcl_stpbv::report {

/// Fills `pair` for the closest of some pairs of bodies at the pair's configuration: answer, bodies,
/// gradient, covers, the hulls' distance and the Lipschitz constant. `report` has the robot and its
/// obstacles.
void measurePair(const CollisionReport& report, const std::vector<CheckedPair>& bodies, PairReport& pair);

}  // namespace fcl_stpbv::report
