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
  /// Without a value each pair is reported in its closest configuration.
  std::optional<Eigen::VectorXd> asked;
  Trajectory trajectory;              ///< no points: none was asked for
  std::vector<std::string> warnings;  ///< of what leaves the joints' limits
};

/// Reads all of them before any volume is built, so that mistakes are reported at once. `srdf` is null
/// without one. @throws Error naming the option and what is wrong.
AskedPostures readPostures(const ReportRequest& request, const Kinematics& kinematics, const Srdf* srdf);

}  // namespace fcl_stpbv::report
