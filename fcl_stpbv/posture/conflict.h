// Which constraints cannot hold together, seen from one start.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/posture/problem.h"

namespace fcl_stpbv {

/// Where the sum of the squared violations is least: whatever is violated there pulls against the rest.
struct Conflict {
  Eigen::VectorXd x;
  std::vector<Violation> rows;      ///< farther than the tolerance from holding, worst first
  std::vector<std::string> limits;  ///< variables that a violated row pushes against a bound
};

Conflict findConflict(PostureProblem& problem, const Eigen::VectorXd& start, double tolerance);

}  // namespace fcl_stpbv
