// The starts of a posture search: the task's own, random ones near it, and repaired versions of the best
// posture so far.
#pragma once

#include <cstdint>
#include <optional>
#include <random>

#include "fcl_stpbv/posture/problem.h"

namespace fcl_stpbv::detail {

/// The starts of a search by their numbers. The problem and the task's start must outlive this object.
class Starts {
 public:
  /// From the start number `first` on, not below 0. `spread`: PostureSetup's.
  Starts(PostureProblem& problem, const Eigen::VectorXd& start, const Eigen::VectorXd& spread,
         std::uint64_t seed, long long first);

  /// Number 0 is the task's own. The others are random postures around it: joints up to half way to anywhere
  /// within their limits and the spread, a moving base up to 10 cm and 0.2 rad away, and what has no limits
  /// likewise 0.1 m or rad.
  Eigen::VectorXd next();

  /// Repairs the variables x. For each violated inequality, the coordinates on which it depends are redrawn
  /// at random within their limits, until it holds and the inequalities' violations have a smaller sum. There
  /// are some hundred draws in total. So collisions of unrelated pairs are removed one after the other, while
  /// a random posture would have to remove all of them at once. No value if x violates no inequality.
  std::optional<Eigen::VectorXd> mended(const Eigen::VectorXd& x, const SolverOptions& options);

  /// A random posture within the limits and the spread: the one with the smallest violations of ten.
  Eigen::VectorXd anywhere();

 private:
  Eigen::VectorXd randomPosture(double way);
  void beginAnew();

  PostureProblem& problem_;
  const Eigen::VectorXd& start_;
  Eigen::VectorXd lower_, upper_;  // of random values
  std::uint64_t seed_;
  long long next_;  // number of the start that comes next
  std::mt19937_64 random_;
};

}  // namespace fcl_stpbv::detail
