// Where searches for a posture start: at random ones near the task's, and at the best so far, mended.
#pragma once

#include <cstdint>
#include <optional>
#include <random>

#include "fcl_stpbv/posture/problem.h"

namespace fcl_stpbv::detail {

/// The random numbers begin anew at starts whose numbers this divides, so that none is a long way off.
constexpr long long kRandomAnew = 100000;

/// The state of the random numbers before the start of this number, which is not negative.
std::mt19937_64 randomBefore(const PostureProblem& problem, const Eigen::VectorXd& start, std::uint64_t seed,
                             long long number);

/// A random posture around the start: joints up to half way to anywhere within their limits, a moving base up
/// to 10 cm and 0.2 rad away, and what has no limits likewise 0.1 m or rad.
Eigen::VectorXd randomStart(const PostureProblem& problem, const Eigen::VectorXd& start,
                            std::mt19937_64& random);

/// The variables x, mended: for each inequality that they violate, the coordinates on which that one depends
/// are drawn anywhere within their limits, some hundred times for all, until it holds and all inequalities
/// together miss less. So pairs that have little to do with each other are freed one after the other, where a
/// random posture would have to free all of them at once. Nothing where x violates no inequality.
std::optional<Eigen::VectorXd> mended(PostureProblem& problem, const Eigen::VectorXd& x,
                                      const Eigen::VectorXd& start, const SolverOptions& options,
                                      std::mt19937_64& random);

}  // namespace fcl_stpbv::detail
