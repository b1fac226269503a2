// The posture generator, for each start:
// 1. minimise the violations (approach.h), first with a low weight of collisions, then with the full weight;
// 2. solve by SLSQP from there (slsqp.cpp);
// 3. stop at the first feasible posture.
// If no start gives one, the joints of the violated constraints in the best posture are redrawn, and the
// search continues from there; after that from random postures. If that fails too, the minimum of the sum of
// squared violations gives the constraints in conflict and the limits that they push against. If no violation
// is left there, it is a feasible posture itself.
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

// The sum of the violations; infinite if one is NaN, so that nothing is worse.
double total(const std::vector<Violation>& violations) {
  double sum = 0;
  for (const Violation& v : violations) sum += v.amount;
  return std::isfinite(sum) ? sum : kInfinity;
}

// The names of constraints and limits with almost no slack.
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

// The limits of variables against which the violated constraints push.
std::vector<std::string> pushedLimits(const PostureProblem& problem, const NearPosture& least) {
  // A smaller slope is only what the descent left over.
  const double push = 0.05 * least.slope.lpNorm<Eigen::Infinity>();
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

// SLSQP from x. If the result has larger violations or, without violations, a higher cost, x is kept.
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
// 1. damped steps, to a point near the posture;
// 2. sequential quadratic programming;
// 3. if that ends close to feasible, minimise the violations again, and, if the constraints hold then,
//    continue from there.
SolverOutcome solve(PostureProblem& problem, const Eigen::VectorXd& start,
                    std::initializer_list<ApproachOptions> approaches, const SolverOptions& options) {
  // If the damped steps end with a larger violation than this (m, rad), the start is given up.
  constexpr double kNear = 0.1;
  // If SLSQP ends with a larger violation than this, more steps rarely help.
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

// Searches for a posture and keeps the best of all points that were tried.
class PostureSearch {
 public:
  PostureSearch(PostureProblem& problem, const Eigen::VectorXd& spread, const PostureOptions& options)
      : problem_(problem), spread_(spread), options_(options), solver_(options.solver) {}

  /// Tries the starts at and around `start` one after the other, until one leads to a posture.
  void fromStarts(const Eigen::VectorXd& start) {
    // The cost pulls the constraints apart by about this times their multipliers: millimetres.
    constexpr double kCostWeight = 1e-4;
    // A low weight of collisions comes first: a hand that would get stuck in front of an obstacle passes
    // through it and is pushed out behind it.
    constexpr double kSoft = 0.3, kFirm = 1;
    const long long first = std::max(0, options_.firstStart), last = first + std::max(1, options_.starts);
    Starts starts(problem_, start, spread_, options_.seed, first);
    for (long long i = first; i < last && !best_.feasible; ++i) {
      ++best_.starts;
      consider(solve(problem_, problem_.variablesAt(starts.next()),
                     {{kCostWeight, kSoft}, {kCostWeight, kFirm}}, solver_));
      if (stopped()) return;
    }
    for (int i = 0; i < options_.repairs && goesOn(); ++i) {
      const std::optional<Eigen::VectorXd> x = starts.mended(x_, solver_);
      if (!x) break;
      const ApproachOptions firm;  // without the cost, which would pull the pairs into each other again
      consider(solve(problem_, *x, {firm}, solver_));
    }
    for (int i = 0; i < options_.anywhere && goesOn(); ++i)
      consider(solve(problem_, starts.anywhere(), {ApproachOptions{}}, solver_));
  }

  /// Finds the constraints in conflict if no start led to a posture.
  void explain() {
    // Largest number of steps to the point where the constraints hold best. Next to singular postures the
    // steps are many and short.
    constexpr int kLongest = 150;
    if (goesOn()) {
      ApproachOptions toTheEnd;
      toTheEnd.maxIterations = kLongest;
      const NearPosture least = approached(problem_, x_, toTheEnd, solver_);
      best_.conflict = problem_.missed(least.x, solver_.tolerance);
      if (best_.conflict.empty())  // then all constraints can hold together
        consider(improve(problem_, least.x, solver_));
      else
        best_.conflictLimits = pushedLimits(problem_, least);
    }
    if (!best_.feasible && stopped()) {
      best_.status = "stopped";
      best_.conflict.clear();
      best_.conflictLimits.clear();
    }
    if (!problem_.unavoidable().empty()) {  // these collide, whatever else holds
      best_.feasible = false;
      best_.status = "bodies that no joint can move apart collide";
      best_.violations = problem_.violations(x_, solver_.tolerance);
      best_.conflict.insert(best_.conflict.begin(), problem_.unavoidable().begin(),
                            problem_.unavoidable().end());
    }
  }

  Posture& best() { return best_; }
  const Eigen::VectorXd& x() const { return x_; }

 private:
  bool stopped() const { return solver_.stop && solver_.stop(); }
  bool goesOn() const { return !best_.feasible && !stopped(); }

  void consider(const SolverOutcome& outcome) {
    std::vector<Violation> violations = problem_.missed(outcome.x, solver_.tolerance);
    best_.iterations += outcome.iterations;
    if (x_.size() > 0 && !(total(violations) < total(best_.violations))) return;
    best_.violations = std::move(violations);
    best_.feasible = best_.violations.empty();
    best_.status = !best_.feasible && outcome.status == "converged" ? "stuck" : outcome.status;
    x_ = outcome.x;
  }

  PostureProblem& problem_;
  const Eigen::VectorXd& spread_;  // of random starts
  const PostureOptions& options_;
  const SolverOptions& solver_;
  Posture best_;
  Eigen::VectorXd x_;  // variables of the best posture
};

}  // namespace

Posture findPosture(PostureSetup& setup, const PostureOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  PostureProblem& problem = *setup.problem;
  const Eigen::Index size = setup.start.size();
  if (size != problem.kinematics().size())
    throw Error("findPosture: the start has " + std::to_string(size) + " coordinates, the robot " +
                std::to_string(problem.kinematics().size()));
  const long queriesBefore = problem.queries();
  PostureSearch search(problem, setup.spread, options);
  // The random starts are around one within the limits: around another all could end at the same limit.
  search.fromStarts(problem.variablesAt(setup.start).head(size));
  search.explain();
  Posture& best = search.best();
  best.seconds = elapsed();
  best.q = search.x().head(size);
  best.cost = problem.evaluate(search.x()).cost;
  best.active = activeAt(problem, search.x());
  best.distanceCalls = best.gradientCalls = problem.queries() - queriesBefore;
  return std::move(best);
}

}  // namespace fcl_stpbv
