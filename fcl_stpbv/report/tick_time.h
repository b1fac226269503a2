// How long a controller would take for the checked pairs of a report.
#pragma once

#include "fcl_stpbv/report/collision_report.h"

namespace fcl_stpbv::report {

/// Median time for all checked pairs with their Jacobian (s), in small steps around `q`, everything warm.
double tickTime(const CollisionReport& report, Eigen::VectorXd q, int threads);

}  // namespace fcl_stpbv::report
