// Solving a posture's optimisation problem from one start.
#pragma once

#include <string>

#include "fcl_stpbv/posture/problem.h"

namespace fcl_stpbv {

/// When a solver ends.
struct SolverOptions {
  int maxIterations = 300;      ///< models built at most
  double maxSeconds = 10;       ///< s
  double tolerance = 1e-6;      ///< a constraint holds within this (m, rad)
  double costTolerance = 1e-8;  ///< relative change of the cost in one iteration at which it ends
  /// Inequalities with more slack than this are left out of an iteration's model until they have less.
  double activation = 0.1;
};

/// Where a solver ended.
struct SolverOutcome {
  Eigen::VectorXd x;   ///< best found: the constraints hold, or are least violated
  int iterations = 0;  ///< models built, each from one evaluation of all derivatives
  std::string status;  ///< why it ended, for people
};

/// Sequential quadratic programming by NLopt's SLSQP.
SolverOutcome solveBySlsqp(PostureProblem& problem, const Eigen::VectorXd& start,
                           const SolverOptions& options);

}  // namespace fcl_stpbv
