// See find_posture.h.
#include "fcl_stpbv/posture/find_posture.h"

#include <chrono>
#include <random>

#include "fcl_stpbv/posture/conflict.h"

namespace fcl_stpbv {
namespace {

// A random posture around the start: joints up to half way to anywhere within their limits, a moving base
// up to 10 cm and 0.2 rad away.
Eigen::VectorXd randomStart(const PostureProblem& problem, const Eigen::VectorXd& start,
                            std::mt19937_64& random) {
  const Kinematics& kinematics = problem.kinematics();
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  Eigen::VectorXd q = start;
  for (int i = 0; i < kinematics.size(); ++i)
    q[i] += 0.5 * (problem.lower()[i] + uniform() * (problem.upper()[i] - problem.lower()[i]) - start[i]);
  for (const Kinematics::Motion& motion : kinematics.motions()) {
    if (motion.joint >= 0) continue;
    const bool turns = std::isfinite(kinematics.lower()[motion.coordinate]);
    q[motion.coordinate] = start[motion.coordinate] + (turns ? 0.2 : 0.1) * (2 * uniform() - 1);
  }
  return q;
}

double total(const std::vector<Violation>& violations) {
  double sum = 0;
  for (const Violation& v : violations) sum += v.amount;
  return sum;
}

// What has next to no slack.
std::vector<std::string> activeAt(PostureProblem& problem, const Eigen::VectorXd& x) {
  constexpr double kSlack = 1e-4;  // m, rad
  const PostureValues& values = problem.evaluate(x);
  std::vector<std::string> names;
  for (int i = 0; i < problem.inequalities(); ++i)
    if (values.atLeast[i] < kSlack) names.push_back(problem.inequalityName(i));
  for (int i = 0; i < problem.kinematics().size(); ++i) {
    if (x[i] < problem.lower()[i] + kSlack) names.push_back(problem.variableName(i) + " (lower limit)");
    if (x[i] > problem.upper()[i] - kSlack) names.push_back(problem.variableName(i) + " (upper limit)");
  }
  return names;
}

}  // namespace

Posture findPosture(PostureSetup& setup, const PostureOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  PostureProblem& problem = *setup.problem;
  const long queriesBefore = setup.collisions ? setup.collisions->queries() : 0;
  std::mt19937_64 random(options.seed);
  Posture best;
  Eigen::VectorXd bestX;
  for (int i = 0; i < options.starts && !best.feasible; ++i) {
    const Eigen::VectorXd q = i == 0 ? setup.start : randomStart(problem, setup.start, random);
    const SolverOutcome outcome = solveBySlsqp(problem, problem.variablesAt(q), options.solver);
    std::vector<Violation> violations = problem.violations(outcome.x, options.solver.tolerance);
    ++best.starts;
    best.iterations += outcome.iterations;
    if (i > 0 && total(violations) >= total(best.violations)) continue;
    best.violations = std::move(violations);
    best.feasible = best.violations.empty();
    best.status = outcome.status;
    bestX = outcome.x;
  }
  best.seconds = elapsed();
  best.q = bestX.head(setup.start.size());
  best.cost = problem.evaluate(bestX).cost;
  best.active = activeAt(problem, bestX);
  best.distanceCalls = best.gradientCalls =
      (setup.collisions ? setup.collisions->queries() : 0) - queriesBefore;
  if (best.feasible) return best;
  Conflict conflict = findConflict(problem, bestX, options.solver.tolerance);
  best.conflict = std::move(conflict.rows);
  best.conflictLimits = std::move(conflict.limits);
  return best;
}

}  // namespace fcl_stpbv
