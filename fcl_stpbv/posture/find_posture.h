// The posture generator: from a task to joint values, or to the constraints that cannot hold together.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fcl_stpbv/posture/problem.h"
#include "fcl_stpbv/posture/task.h"

namespace fcl_stpbv {

/// How long to search.
struct PostureOptions {
  SolverOptions solver;  ///< for each start
  int starts = 5;        ///< at most; number 0 is the task's own, the others random ones near it; 1 at least
  int firstStart = 0;    ///< number of the first one to try; below 0 counts as 0
  std::uint64_t seed = 1;  ///< of the random ones
  int mends = 2;      ///< where no start leads to a posture, the best one is mended at most so many times
  int anywhere = 20;  ///< where no mending leads to one either: starts anywhere within the limits
};

/// What was found.
struct Posture {
  bool feasible = false;              ///< all constraints hold within the solver's tolerance
  Eigen::VectorXd q;                  ///< the best found
  double cost = 0;                    ///< of `q`
  double seconds = 0;                 ///< the search took
  int starts = 0;                     ///< tried
  int iterations = 0;                 ///< of all starts together
  long distanceCalls = 0;             ///< distances computed
  long gradientCalls = 0;             ///< gradients of distances computed
  std::string status;                 ///< why the search ended, for people
  std::vector<Violation> violations;  ///< at q, worst first
  std::vector<std::string> active;    ///< collision rows and joint limits that hold q where it is
  /// Where nothing was feasible: the constraints that pull against each other where their violations are
  /// least in sum of squares, each with what it misses there, and the joint limits that they push against.
  /// Empty where, and only where, `feasible`, or where the search was stopped.
  std::vector<Violation> conflict;
  std::vector<std::string> conflictLimits;  ///< names of the joint limits in the way of `conflict`
};

/// Deterministic for a seed, but for a solver that runs out of time.
/// @throws Error for a start of another size than the robot's, as one of another base; else never.
Posture findPosture(PostureSetup& setup, const PostureOptions& options = {});

}  // namespace fcl_stpbv
