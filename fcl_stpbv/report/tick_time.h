// Measures the time per control period for the checked pairs of a report.
#pragma once

#include "fcl_stpbv/report/collision_report.h"

namespace fcl_stpbv::report {

/// Cost of the rows with their Jacobian, in small steps around `q`, with warm caches. The time is a median.
RowCost tickCost(std::shared_ptr<const Kinematics> kinematics, std::shared_ptr<const RobotGeometry> geometry,
                 const std::vector<CheckedPair>& rows, const ConstraintOptions& options, Eigen::VectorXd q);

/// The closest pair of bodies of each checked pair.
std::vector<CheckedPair> closestBodies(const CollisionReport& report);

}  // namespace fcl_stpbv::report
