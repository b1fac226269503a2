// Minimises the violations of the constraints from any start, by damped Gauss-Newton steps
// (Levenberg-Marquardt).
#pragma once

#include "fcl_stpbv/posture/problem.h"

namespace fcl_stpbv::detail {

struct ApproachOptions {
  double costWeight = 0;     ///< weight of the cost relative to the squared violations
  double atLeastWeight = 1;  ///< weight of squared violations of inequalities relative to those of equalities
  int maxIterations = 50;
  double relativeChange = 1e-9;  ///< stops when the sum changes by less than this fraction in one step
  std::function<bool()> stop{};  ///< SolverOptions::stop
};

struct NearPosture {
  Eigen::VectorXd x;
  /// Gradient of half the sum at x; at a minimum it is 0 for variables that no bound holds.
  Eigen::VectorXd slope;
  int iterations = 0;
};

/// Half of the sum that approach() minimises.
double halfSum(const PostureValues& values, const ApproachOptions& options);

/// Minimises costWeight * cost + the weighted sum of all squared violations, within the bounds
/// (Levenberg-Marquardt). Steps end at bounds, and variables that would leave their bounds are held. Unlike
/// steps of sequential quadratic programming, its steps stay short if the constraints' Jacobian is singular,
/// for example for a robot with straight knees.
NearPosture approach(PostureProblem& problem, const Eigen::VectorXd& start, const ApproachOptions& options);

}  // namespace fcl_stpbv::detail
