// The posture generator, for each start:
// 1. approach the constraints (approach.h), first with light obstacles, then in full;
// 2. solve by SLSQP from there (slsqp.cpp);
// 3. stop at the first feasible posture.
// Without one, the joints of what is violated in the best posture are drawn anew, and the search goes on from
// there; then from postures anywhere. Then the least sum of squared violations names the constraints in
// conflict and the limits they push against. Where it leaves none, it is a feasible posture itself.
#include "fcl_stpbv/posture/find_posture.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <initializer_list>
#include <optional>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/posture/approach.h"
#include "fcl_stpbv/posture/starts.h"

namespace fcl_stpbv {
namespace {

using namespace detail;

// Infinite where one is no number, so that nothing is worse.
double total(const std::vector<Violation>& violations) {
  double sum = 0;
  for (const Violation& v : violations) sum += v.amount;
  return std::isfinite(sum) ? sum : kInfinity;
}

// What has next to no slack.
std::vector<std::string> activeAt(PostureProblem& problem, const Eigen::VectorXd& x) {
  constexpr double kSlack = 1e-4;  // m, rad
  const PostureValues& values = problem.evaluate(x);
  std::vector<std::string> names;
  for (int i = 0; i < problem.inequalities(); ++i)
    if (values.atLeast[i] < kSlack) names.push_back(problem.inequalityName(i));
  for (int i = 0; i < problem.kinematics().size(); ++i) {
    if (x[i] < problem.lower()[i] + kSlack) names.push_back(problem.limitName(i, false));
    if (x[i] > problem.upper()[i] - kSlack) names.push_back(problem.limitName(i, true));
  }
  return names;
}

// Variables that the violated constraints push against a bound.
std::vector<std::string> pushedLimits(const PostureProblem& problem, const NearPosture& least) {
  const double push = 0.05 * least.slope.lpNorm<Eigen::Infinity>();  // less is what the descent left
  std::vector<std::string> names;
  for (int i = 0; i < problem.variables(); ++i) {
    const bool low = least.x[i] <= problem.lower()[i] && least.slope[i] > push;
    const bool high = least.x[i] >= problem.upper()[i] && least.slope[i] < -push;
    if (low || high) names.push_back(problem.limitName(i, high));
  }
  return names;
}

NearPosture approached(PostureProblem& problem, const Eigen::VectorXd& from, ApproachOptions how,
                       const SolverOptions& options) {
  how.stop = options.stop;
  return approach(problem, from, how);
}

// SLSQP from x. Where it ends at more violations or, with none, at more cost, x stands.
SolverOutcome improve(PostureProblem& problem, const Eigen::VectorXd& x, const SolverOptions& options) {
  const auto rank = [&](const Eigen::VectorXd& at) {
    const double violated = total(problem.missed(at, options.tolerance));
    return std::make_pair(violated, problem.evaluate(at).cost);
  };
  const auto before = rank(x);
  SolverOutcome outcome = solveBySlsqp(problem, x, options);
  const auto after = rank(outcome.x);
  if (before < after || std::isnan(after.second)) outcome.x = x;
  return outcome;
}

// From one start:
// 1. near to the posture by damped steps;
// 2. to it by sequential quadratic programming;
// 3. where that ends close by, to where the constraints hold best, and if they hold on from there.
SolverOutcome solve(PostureProblem& problem, const Eigen::VectorXd& start,
                    std::initializer_list<ApproachOptions> approaches, const SolverOptions& options) {
  // Farther away than this (m, rad) where the damped steps end, the start leads into a dead end.
  constexpr double kNear = 0.1;
  // Farther away than this where the programming ends, more steps seldom get there.
  constexpr double kClose = 1e-3;
  const auto worst = [&](const Eigen::VectorXd& x) {
    const std::vector<Violation> list = problem.missed(x, options.tolerance);
    return list.empty() ? 0.0 : list.front().amount;
  };
  NearPosture near{start, {}, 0};
  int iterations = 0;
  for (const ApproachOptions& how : approaches) {
    near = approached(problem, near.x, how, options);
    iterations += near.iterations;
  }
  if (worst(near.x) > kNear) return {near.x, iterations, "stuck"};
  SolverOutcome outcome = improve(problem, near.x, options);
  iterations += outcome.iterations;
  const double missed = worst(outcome.x);
  if (missed > 0 && missed < kClose) {
    near = approached(problem, outcome.x, {}, options);
    iterations += near.iterations;
    if (worst(near.x) == 0) {
      outcome = improve(problem, near.x, options);
      iterations += outcome.iterations;
    }
  }
  outcome.iterations = iterations;
  return outcome;
}

}  // namespace

Posture findPosture(PostureSetup& setup, const PostureOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  // Steps to where the constraints hold best: next to singular postures they are many and short.
  constexpr int kLongest = 150;
  // The cost pulls the constraints apart by about this times their multipliers: millimetres.
  constexpr double kCostWeight = 1e-4;
  // Soft obstacles first: a hand that would be caught before one passes through it and is pushed out behind.
  constexpr double kSoft = 0.3, kFirm = 1;
  PostureProblem& problem = *setup.problem;
  if (setup.start.size() != problem.kinematics().size())
    throw Error("findPosture: the start has " + std::to_string(setup.start.size()) +
                " coordinates, the robot " + std::to_string(problem.kinematics().size()));
  const long queriesBefore = problem.queries();
  Posture best;
  Eigen::VectorXd bestX;
  const auto consider = [&](const SolverOutcome& outcome) {
    std::vector<Violation> violations = problem.missed(outcome.x, options.solver.tolerance);
    best.iterations += outcome.iterations;
    if (bestX.size() > 0 && !(total(violations) < total(best.violations))) return;
    best.violations = std::move(violations);
    best.feasible = best.violations.empty();
    best.status = !best.feasible && outcome.status == "converged" ? "stuck" : outcome.status;
    bestX = outcome.x;
  };
  const long long first = std::max(0, options.firstStart), last = first + std::max(1, options.starts);
  const auto stopped = [&] { return options.solver.stop && options.solver.stop(); };
  // The random starts are around one within the limits: around another all could end at the same limit.
  const Eigen::VectorXd start = problem.variablesAt(setup.start).head(setup.start.size());
  Starts starts(problem, start, options.seed, first);
  for (long long i = first; i < last && !best.feasible; ++i) {
    ++best.starts;
    consider(solve(problem, problem.variablesAt(starts.next()), {{kCostWeight, kSoft}, {kCostWeight, kFirm}},
                   options.solver));
    if (stopped()) break;
  }
  for (int i = 0; i < options.mends && !best.feasible && !stopped(); ++i) {
    const std::optional<Eigen::VectorXd> x = starts.mended(bestX, options.solver);
    if (!x) break;
    const ApproachOptions firm;  // without the cost, which would pull the pairs into each other again
    consider(solve(problem, *x, {firm}, options.solver));
  }
  for (int i = 0; i < options.anywhere && !best.feasible && !stopped(); ++i)
    consider(solve(problem, starts.anywhere(), {ApproachOptions{}}, options.solver));
  if (!best.feasible && !stopped()) {
    ApproachOptions toTheEnd;
    toTheEnd.maxIterations = kLongest;
    const NearPosture least = approached(problem, bestX, toTheEnd, options.solver);
    best.conflict = problem.missed(least.x, options.solver.tolerance);
    if (best.conflict.empty())  // then they can hold together
      consider(improve(problem, least.x, options.solver));
    else
      best.conflictLimits = pushedLimits(problem, least);
  }
  if (!best.feasible && stopped()) {
    best.status = "stopped";
    best.conflict.clear();
    best.conflictLimits.clear();
  }
  if (!problem.still().empty()) {  // whatever else holds
    best.feasible = false;
    best.status = "in collision where nothing moves";
    best.violations = problem.violations(bestX, options.solver.tolerance);
    best.conflict.insert(best.conflict.begin(), problem.still().begin(), problem.still().end());
  }
  best.seconds = elapsed();
  best.q = bestX.head(setup.start.size());
  best.cost = problem.evaluate(bestX).cost;
  best.active = activeAt(problem, bestX);
  best.distanceCalls = best.gradientCalls = problem.queries() - queriesBefore;
  return best;
}

}  // namespace fcl_stpbv
