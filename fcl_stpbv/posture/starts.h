// Where searches for a posture start: at random ones near the task's, and at the best so far, mended.
#pragma once

#include <cstdint>
#include <optional>
#include <random>

#include "fcl_stpbv/posture/problem.h"

namespace fcl_stpbv::detail {

/// The starts of a search by their numbers. The problem and the task's start must outlive it.
class Starts {
 public:
  /// From the start number `first` on, not below 0.
  Starts(PostureProblem& problem, const Eigen::VectorXd& start, std::uint64_t seed, long long first);

  /// Number 0 is the task's own. The others are random postures around it: joints up to half way to anywhere
  /// within their limits, a moving base up to 10 cm and 0.2 rad away, and what has no limits likewise 0.1 m
  /// or rad.
  Eigen::VectorXd next();

  /// The variables x, mended: for each inequality that they violate, the coordinates on which that one
  /// depends are drawn anywhere within their limits, some hundred times for all, until it holds and all
  /// inequalities together miss less. So pairs that have little to do with each other are freed one after the
  /// other, where a random posture would have to free all of them at once. Nothing where x violates no
  /// inequality.
  std::optional<Eigen::VectorXd> mended(const Eigen::VectorXd& x, const SolverOptions& options);

  /// Variables of a posture anywhere within the limits: of ten random ones that which misses least.
  Eigen::VectorXd anywhere();

 private:
  Eigen::VectorXd randomPosture(double way);
  void beginAnew();

  PostureProblem& problem_;
  const Eigen::VectorXd& start_;
  std::uint64_t seed_;
  long long next_;  // number of the start that comes next
  std::mt19937_64 random_;
};

}  // namespace fcl_stpbv::detail
