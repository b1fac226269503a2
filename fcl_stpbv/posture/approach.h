// From anywhere to where the constraints hold as well as they can, by damped Gauss-Newton steps.
#pragma once

#include "fcl_stpbv/posture/problem.h"

namespace fcl_stpbv::detail {

struct ApproachOptions {
  double costWeight = 0;     ///< of the cost beside the squared violations
  double atLeastWeight = 1;  ///< of squared violations of inequalities beside those of equalities
  int maxIterations = 50;
  double relativeChange = 1e-9;  ///< of the sum in one step, at which it is least
  std::function<bool()> stop{};  ///< SolverOptions::stop
};

struct NearPosture {
  Eigen::VectorXd x;
  Eigen::VectorXd slope;  ///< of the sum at x; 0 where no bound holds x back
  int iterations = 0;
};

/// Half the sum that approach() minimises.
double halfSum(const PostureValues& values, const ApproachOptions& options);

/// Minimises costWeight * cost + the weighted sum of all squared violations within the bounds (Levenberg and
/// Marquardt; steps end at bounds, variables that would leave them are held). Unlike a step of sequential
/// quadratic programming its steps stay short where the constraints' Jacobian is singular, as it is for a
/// robot that stands with straight knees.
NearPosture approach(PostureProblem& problem, const Eigen::VectorXd& start, const ApproachOptions& options);

}  // namespace fcl_stpbv::detail
