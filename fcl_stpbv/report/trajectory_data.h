// What the report's page knows of a trajectory: its chart, and where the first contact is.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <nlohmann/json_fwd.hpp>

#include "fcl_stpbv/report/collision_report.h"

namespace fcl_stpbv::report {

/// `indexOf` keeps a configuration and says where.
nlohmann::json trajectoryData(const CollisionReport& report,
                              const std::function<std::size_t(const Eigen::VectorXd&)>& indexOf);

}  // namespace fcl_stpbv::report
