// Random postures: a fixed count of random numbers for each, so that one of any number is found without those
// before it.
#include "fcl_stpbv/posture/starts.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fcl_stpbv::detail {

using Eigen::VectorXd;

namespace {

// Joints go up to this part of the way to anywhere within their limits.
constexpr double kHalfWay = 0.5, kAnywhere = 1;

VectorXd randomPosture(const PostureProblem& problem, const VectorXd& start, double way,
                       std::mt19937_64& random) {
  const Kinematics& kinematics = problem.kinematics();
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  VectorXd q = start;
  for (int i = 0; i < kinematics.size(); ++i) {
    const double low = problem.lower()[i], range = problem.upper()[i] - low, share = uniform();
    q[i] += std::isfinite(range) ? way * (low + share * range - start[i]) : 0.1 * (2 * share - 1);
  }
  for (const Kinematics::Motion& motion : kinematics.motions()) {
    if (motion.joint >= 0) continue;
    const bool turns = std::isfinite(kinematics.lower()[motion.coordinate]);
    q[motion.coordinate] = start[motion.coordinate] + (turns ? 0.2 : 0.1) * (2 * uniform() - 1);
  }
  return q;
}

}  // namespace

std::mt19937_64 randomBefore(const PostureProblem& problem, const VectorXd& start, std::uint64_t seed,
                             long long number) {
  std::mt19937_64 random(seed);
  if (number >= kRandomAnew) {
    std::seed_seq words{seed, seed >> 32, static_cast<std::uint64_t>(number / kRandomAnew)};
    random.seed(words);
  }
  for (long long i = number < kRandomAnew ? 1 : 0; i < number % kRandomAnew; ++i)
    randomStart(problem, start, random);
  return random;
}

VectorXd randomStart(const PostureProblem& problem, const VectorXd& start, std::mt19937_64& random) {
  return randomPosture(problem, start, kHalfWay, random);
}

std::optional<VectorXd> mended(PostureProblem& problem, const VectorXd& from, const VectorXd& start,
                               const SolverOptions& options, std::mt19937_64& random) {
  constexpr int kDraws = 400;  // in all
  const auto missed = [](const PostureValues& values) { return -values.atLeast.cwiseMin(0).sum(); };
  const auto holds = [&](const PostureValues& values, int row) {
    return values.atLeast[row] >= -options.tolerance;
  };
  const PostureValues& before = problem.evaluate(from);
  const RowMatrix jacobian = before.atLeastJacobian;
  std::vector<int> violated;
  for (int row = 0; row < problem.inequalities(); ++row)
    if (!holds(before, row)) violated.push_back(row);
  if (violated.empty()) return std::nullopt;

  const int draws = std::max(1, kDraws / static_cast<int>(violated.size()));
  VectorXd x = from;
  double least = missed(before);
  for (const int row : violated) {
    bool done = holds(problem.evaluate(x), row);
    for (int i = 0; i < draws && !done; ++i) {
      if (options.stop && options.stop()) return x;
      const VectorXd anywhere = randomPosture(problem, start, kAnywhere, random);
      VectorXd drawn = x;
      for (Eigen::Index k = 0; k < start.size(); ++k)
        if (jacobian(row, k) != 0) drawn[k] = anywhere[k];
      const PostureValues& values = problem.evaluate(drawn);
      const double now = missed(values);
      if (!(now < least)) continue;
      x = drawn, least = now;
      done = holds(values, row);
    }
  }
  return x;
}

}  // namespace fcl_stpbv::detail
