// The posture generator: finds joint values that fulfil a task, or else names the constraints that conflict.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fcl_stpbv/posture/problem.h"
#include "fcl_stpbv/posture/task.h"

namespace fcl_stpbv {

/// Limits of the search.
struct PostureOptions {
  SolverOptions solver;  ///< settings of the solver for each start
  /// Largest number of starts, at least 1; start 0 is the task's own, the others are random ones near it.
  int starts = 5;
  int firstStart = 0;      ///< number of the first start to try; below 0 counts as 0
  std::uint64_t seed = 1;  ///< seed of the random starts
  /// If no start gives a feasible posture: largest number of times that the joints on which the best
  /// posture's violated inequalities depend are redrawn, and the problem is solved again from there.
  int repairs = 2;
  int anywhere = 20;  ///< if that fails, too: number of starts anywhere within the joint limits
};

/// Result of findPosture().
struct Posture {
  bool feasible = false;              ///< all constraints hold within the solver's tolerance
  Eigen::VectorXd q;                  ///< the best configuration found (rad, m)
  double cost = 0;                    ///< cost of `q`
  double seconds = 0;                 ///< duration of the search (s)
  int starts = 0;                     ///< number of starts tried
  int iterations = 0;                 ///< iterations of all starts together
  long distanceCalls = 0;             ///< distances computed
  long gradientCalls = 0;             ///< gradients of distances computed
  std::string status;                 ///< why the search ended, for people
  std::vector<Violation> violations;  ///< violations at q, worst first
  /// Names of the collision constraints and joint limits that are active at q.
  std::vector<std::string> active;
  /// If no feasible posture was found: the constraints in conflict. They are those still violated at the
  /// configuration with the least sum of squared violations; each amount is its violation there. Empty if and
  /// only if `feasible` or the search was stopped.
  std::vector<Violation> conflict;
  /// Names of the joint limits that the constraints in `conflict` push against.
  std::vector<std::string> conflictLimits;
};

/// Searches for a posture. Deterministic for a given seed, unless `solver.maxSeconds` is set. @throws Error
/// if the start has another size than the robot's coordinates, for example that of another base motion, and
/// whatever `solver.stop` and constraints of your own throw.
Posture findPosture(PostureSetup& setup, const PostureOptions& options = {});

}  // namespace fcl_stpbv
