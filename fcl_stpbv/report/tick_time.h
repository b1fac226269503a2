// How long a controller would take for the checked pairs of a report.
#pragma once

#include "fcl_stpbv/report/collision_report.h"

namespace fcl_stpbv::report {

/// Median time for rows with their Jacobian (s), in small steps around `q`, everything warm.
double tickTime(const CollisionReport& report, std::shared_ptr<const RobotGeometry> geometry,
                const std::vector<CheckedPair>& rows, Eigen::VectorXd q, int threads);

/// The closest bodies of each checked pair.
std::vector<CheckedPair> closestBodies(const CollisionReport& report);

}  // namespace fcl_stpbv::report
