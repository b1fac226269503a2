// Damped Gauss-Newton steps (Levenberg 1944, Marquardt 1963) on the sum of squared violations and a little of
// the cost. A variable that is at its bound and would leave it is held. The damping follows Nielsen's rule
// (1999).
#include "fcl_stpbv/posture/approach.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace fcl_stpbv::detail {
namespace {

// halfSum(), its slope and the Gauss-Newton approximation of its Hessian.
struct Model {
  double value = 0;
  Eigen::VectorXd slope;
  Eigen::MatrixXd hessian;
};

Model modelAt(const PostureValues& values, const Eigen::VectorXd& costCurvature,
              const ApproachOptions& options) {
  Model model;
  model.value = halfSum(values, options);
  model.slope =
      options.costWeight / 2 * values.costGradient + values.equalJacobian.transpose() * values.equal;
  model.hessian = values.equalJacobian.transpose() * values.equalJacobian;
  model.hessian.diagonal() += options.costWeight / 2 * costCurvature;
  for (Eigen::Index i = 0; i < values.atLeast.size(); ++i) {
    if (values.atLeast[i] >= 0) continue;
    const auto row = values.atLeastJacobian.row(i);
    model.slope += options.atLeastWeight * values.atLeast[i] * row.transpose();
    model.hessian.noalias() += options.atLeastWeight * row.transpose() * row;
  }
  return model;
}

}  // namespace

double halfSum(const PostureValues& values, const ApproachOptions& options) {
  return (options.costWeight * values.cost + values.equal.squaredNorm() +
          options.atLeastWeight * values.atLeast.cwiseMin(0).squaredNorm()) /
         2;
}

NearPosture approach(PostureProblem& problem, const Eigen::VectorXd& start, const ApproachOptions& options) {
  constexpr double kDamping = 1e-2;  // of the first step, in the units of the Hessian: m^2 or rad^2 per rad^2
  constexpr double kLeastDamping = 1e-9, kMostDamping = 1e6;
  const int n = problem.variables();
  NearPosture result{start, Eigen::VectorXd::Zero(n), 0};
  double damping = kDamping, growth = 2;
  Model model = modelAt(problem.evaluate(result.x), problem.costCurvature(), options);
  while (result.iterations < options.maxIterations && damping < kMostDamping) {
    if (options.stop && options.stop()) break;
    ++result.iterations;
    Eigen::MatrixXd hessian = model.hessian;
    Eigen::VectorXd slope = model.slope;
    hessian.diagonal().array() += damping;
    for (int i = 0; i < n; ++i) {
      const bool held = (result.x[i] <= problem.lower()[i] && slope[i] > 0) ||
                        (result.x[i] >= problem.upper()[i] && slope[i] < 0);
      if (!held) continue;
      hessian.row(i).setZero();
      hessian.col(i).setZero();
      hessian(i, i) = 1;
      slope[i] = 0;
    }
    const Eigen::VectorXd whole = -hessian.ldlt().solve(slope);
    const Eigen::VectorXd moved = (result.x + whole).cwiseMax(problem.lower()).cwiseMin(problem.upper());
    const auto foretold = [&](const Eigen::VectorXd& step) {
      return -model.slope.dot(step) - step.dot(model.hessian * step) / 2;
    };
    const double expected = foretold(moved - result.x);
    const double reduction = model.value - halfSum(problem.evaluate(moved), options);
    if (!(reduction > 0)) {
      // A step that a bound shortens may increase the sum although a shorter step would lower it. With the
      // cost, such a point is good enough; without it, only the minimum is.
      const double hoped = options.costWeight > 0 ? expected : foretold(whole);
      if (!(hoped > options.relativeChange * model.value)) break;
      damping *= growth;
      growth *= 2;
      continue;
    }
    // Nielsen's rule: the better the model foretold the reduction, the longer the next step.
    const double ratio = reduction / std::max(expected, 1e-300);
    damping = std::max(kLeastDamping, damping * std::max(1.0 / 3, 1 - std::pow(2 * ratio - 1, 3)));
    growth = 2;
    const bool least = reduction <= options.relativeChange * model.value;
    result.x = moved;
    model = modelAt(problem.evaluate(moved), problem.costCurvature(), options);
    if (least) break;
  }
  result.slope = model.slope;
  return result;
}

}  // namespace fcl_stpbv::detail
