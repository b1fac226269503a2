// The second derivatives that the benchmark posture_ipopt gives IPOPT, against differences of the first ones.
#include <catch2/catch.hpp>

#include "test/posture/scenes.h"
#include "test/reference/shapes.h"
#include "tools/bench/posture_ipopt/hessian.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::benchmark;
using namespace fcl_stpbv::test;

namespace {

// Differences with this step are accurate to its square times the third derivatives (at most about 10 here)
// plus the first derivatives' rounding divided by the step (1e-10), for each of about 20 rows.
constexpr double kSmallMove = 1e-6, kHessianAgrees = 1e-8;

Eigen::VectorXd randomWeights(int rows, Random& random) {
  Eigen::VectorXd weights(rows);
  for (double& w : weights) w = random.uniform(-1, 1);
  return weights;
}

// Without the distances, whose Hessian has tests of its own.
// If `away` is not negative, the last frame is turned away from its target by this angle (rad).
double worstEntry(PostureTask task, const PostureScene& scene, Random& random, double away) {
  constexpr double kInfluence = 0.2;
  PostureSetup setup = setUp(task, scene, kInfluence);
  Eigen::VectorXd x = setup.problem->variablesAt(setup.start);
  for (double& value : x) value += random.uniform(-0.2, 0.2);
  if (away >= 0) {
    const Kinematics& kinematics = setup.problem->kinematics();
    Kinematics::State state = kinematics.makeState();
    kinematics.forward(x.head(kinematics.size()), state);
    Placement& last = task.placements.back().placement;
    const auto link = static_cast<std::size_t>(scene.robot->link(task.placements.back().link));
    last.target = state.link[link] * last.frame * Eigen::AngleAxisd(away, random.direction());
    setup = setUp(task, scene, kInfluence);
  }
  PostureProblem& problem = *setup.problem;
  PostureHessian hessian(setup, task, scene, kInfluence);
  const Eigen::VectorXd equal = randomWeights(problem.equalities(), random);
  Eigen::VectorXd atLeast = randomWeights(problem.inequalities(), random);
  atLeast.tail(static_cast<Eigen::Index>(setup.pairs.size())).setZero();
  const auto slope = [&](const Eigen::VectorXd& at) -> Eigen::VectorXd {
    const PostureValues& values = problem.evaluate(at);
    return values.equalJacobian.transpose() * equal + values.atLeastJacobian.transpose() * atLeast;
  };
  Eigen::MatrixXd lower;
  hessian.evaluate(x, equal, atLeast, lower);
  double worst = 0;
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    const Eigen::VectorXd step = kSmallMove * Eigen::VectorXd::Unit(x.size(), j);
    const Eigen::VectorXd column = (slope(x + step) - slope(x - step)) / (2 * kSmallMove);
    worst = std::max(worst, (column - lower.col(j)).tail(x.size() - j).cwiseAbs().maxCoeff());
  }
  return worst;
}

}  // namespace

TEST_CASE("the second derivatives of placements and stability agree with differences") {
  Random random(1);
  const PostureScene scene = hrp2Scene();
  const std::array<std::array<bool, 6>, 4> cases{{{},
                                                  {false, true, false, true, false, false},
                                                  {true, false, false, false, true, false},
                                                  {false, false, false, true, true, true}}};
  for (const auto& isFree : cases)
    for (const double away : {-1.0, 0.0, 1e-5, 5e-3, 2e-2}) {  // around the ends of the series
      PostureTask task = pickCan();
      task.stabilityMargin = away < 0 ? 0 : 0.02;
      task.placements.back().placement.free = isFree;
      CHECK(worstEntry(task, scene, random, away) < kHessianAgrees);
    }
}
