// The postures and way points for which a report was requested.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "fcl_stpbv/report/collision_report.h"

namespace fcl_stpbv::report {

struct AskedPostures {
  Eigen::VectorXd neutral;
  /// Without a value, each pair is reported in its closest configuration.
  std::optional<Eigen::VectorXd> asked;
  Trajectory trajectory;              ///< without points if none was requested
  std::vector<std::string> warnings;  ///< about values beyond the joints' limits
};

/// Reads all of them before any volume is built, so that mistakes are reported at once. `srdf` is null if
/// there is none. @throws Error naming the option and what is wrong.
AskedPostures readPostures(const ReportRequest& request, const Kinematics& kinematics, const Srdf* srdf);

}  // namespace fcl_stpbv::report
