// The postures and way points that a report is asked for.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "fcl_stpbv/report/collision_report.h"

namespace fcl_stpbv::report {

struct AskedPostures {
  Eigen::VectorXd neutral;
  std::optional<Eigen::VectorXd> asked;  ///< none: each pair is reported in its closest configuration
  Trajectory trajectory;                 ///< no points: none was asked for
  std::vector<std::string> warnings;     ///< of what leaves the joints' limits
};

/// All are read before a volume is built, so that a mistake in them is told at once. `srdf` is null without
/// one. @throws Error naming the option and what is wrong.
AskedPostures readPostures(const ReportRequest& request, const Kinematics& kinematics, const Srdf* srdf);

}  // namespace fcl_stpbv::report
