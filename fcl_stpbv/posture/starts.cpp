// Each random posture uses a fixed number of random numbers, and each start continues after the one before.
// The generator is reseeded every 100,000 starts, so that any start can be reached quickly.
#include "fcl_stpbv/posture/starts.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/posture/approach.h"

namespace fcl_stpbv::detail {

using Eigen::VectorXd;

namespace {

constexpr long long kAnew = 100000;
// Joints go up to this share of the way from the start to anywhere within their limits.
constexpr double kHalfWay = 0.5, kAnywhere = 1;

}  // namespace

Starts::Starts(PostureProblem& problem, const VectorXd& start, const VectorXd& spread, std::uint64_t seed,
               long long first)
    : problem_(problem),
      start_(start),
      lower_(problem.lower().head(start.size())),
      upper_(problem.upper().head(start.size())),
      seed_(seed),
      next_(first - first % kAnew) {
  if (spread.size() > 0) {
    lower_ = lower_.cwiseMax(start - spread);
    upper_ = upper_.cwiseMin(start + spread);
  }
  beginAnew();
  while (next_ < first) next();
}

void Starts::beginAnew() {
  if (next_ == 0) {
    random_.seed(seed_);
    return;
  }
  std::seed_seq words{seed_, seed_ >> 32, static_cast<std::uint64_t>(next_ / kAnew)};
  random_.seed(words);
}

VectorXd Starts::next() {
  if (next_ % kAnew == 0) beginAnew();
  return next_++ == 0 ? start_ : randomPosture(kHalfWay);
}

VectorXd Starts::randomPosture(double way) {
  const Kinematics& kinematics = problem_.kinematics();
  const auto uniform = [&] { return static_cast<double>(random_() >> 11) * 0x1p-53; };
  VectorXd q = start_;
  for (int i = 0; i < kinematics.size(); ++i) {
    const double low = lower_[i], range = upper_[i] - low, share = uniform();
    q[i] += std::isfinite(range) ? way * (low + share * range - start_[i]) : 0.1 * (2 * share - 1);
  }
  for (const Kinematics::Motion& motion : kinematics.motions()) {
    if (motion.joint >= 0) continue;
    const bool turns = std::isfinite(kinematics.lower()[motion.coordinate]);
    q[motion.coordinate] = start_[motion.coordinate] + (turns ? 0.2 : 0.1) * (2 * uniform() - 1);
  }
  return q;
}

VectorXd Starts::anywhere() {
  constexpr int kDraws = 10;
  VectorXd nearest;
  double least = kInfinity;
  for (int i = 0; i < kDraws; ++i) {
    const VectorXd x = problem_.variablesAt(randomPosture(kAnywhere));
    const double missed = halfSum(problem_.evaluate(x), {});
    if (nearest.size() == 0 || missed < least) nearest = x, least = missed;
  }
  return nearest;
}

std::optional<VectorXd> Starts::mended(const VectorXd& from, const SolverOptions& options) {
  constexpr int kDraws = 400;  // in total
  const auto missed = [](const PostureValues& values) { return -values.atLeast.cwiseMin(0).sum(); };
  const auto holds = [&](const PostureValues& values, int row) {
    return values.atLeast[row] >= -options.tolerance;
  };
  const PostureValues& before = problem_.evaluate(from);
  const RowMatrix jacobian = before.atLeastJacobian;
  std::vector<int> violated;
  for (int row = 0; row < problem_.inequalities(); ++row)
    if (!holds(before, row)) violated.push_back(row);
  if (violated.empty()) return std::nullopt;

  const int draws = std::max(1, kDraws / static_cast<int>(violated.size()));
  VectorXd x = from;
  double least = missed(before);
  for (const int row : violated) {
    bool done = holds(problem_.evaluate(x), row);
    for (int i = 0; i < draws && !done; ++i) {
      if (options.stop && options.stop()) return x;
      const VectorXd anywhere = randomPosture(kAnywhere);
      VectorXd drawn = x;
      for (Eigen::Index k = 0; k < start_.size(); ++k)
        if (jacobian(row, k) != 0) drawn[k] = anywhere[k];
      const PostureValues& values = problem_.evaluate(drawn);
      const double now = missed(values);
      if (!(now < least)) continue;
      x = drawn, least = now;
      done = holds(values, row);
    }
  }
  return x;
}

}  // namespace fcl_stpbv::detail
