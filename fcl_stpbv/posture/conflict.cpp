// See conflict.h.
#include "fcl_stpbv/posture/conflict.h"

#include <nlopt.h>

#include <algorithm>
#include <memory>

namespace fcl_stpbv {
namespace {

// Half the sum of the squared violations.
double violation(PostureProblem& problem, const Eigen::Ref<const Eigen::VectorXd>& x,
                 Eigen::VectorXd& gradient) {
  const PostureValues& values = problem.evaluate(x);
  const Eigen::VectorXd missing = values.atLeast.cwiseMin(0);
  gradient = values.equalJacobian.transpose() * values.equal + values.atLeastJacobian.transpose() * missing;
  return (values.equal.squaredNorm() + missing.squaredNorm()) / 2;
}

double objective(unsigned n, const double* x, double* gradient, void* data) {
  Eigen::VectorXd slope;
  const double value =
      violation(*static_cast<PostureProblem*>(data), Eigen::Map<const Eigen::VectorXd>(x, n), slope);
  if (gradient) Eigen::Map<Eigen::VectorXd>(gradient, n) = slope;
  return value;
}

struct Delete {
  void operator()(nlopt_opt opt) const { nlopt_destroy(opt); }
};

}  // namespace

Conflict findConflict(PostureProblem& problem, const Eigen::VectorXd& start, double tolerance) {
  constexpr int kEvaluations = 400;
  Conflict conflict{start, {}, {}};
  const std::unique_ptr<nlopt_opt_s, Delete> opt(
      nlopt_create(NLOPT_LD_SLSQP, static_cast<unsigned>(problem.variables())));
  nlopt_set_lower_bounds(opt.get(), problem.lower().data());
  nlopt_set_upper_bounds(opt.get(), problem.upper().data());
  nlopt_set_min_objective(opt.get(), objective, &problem);
  nlopt_set_maxeval(opt.get(), kEvaluations);
  nlopt_set_ftol_rel(opt.get(), 1e-9);
  nlopt_set_stopval(opt.get(), tolerance * tolerance / 100);
  double least;
  nlopt_optimize(opt.get(), conflict.x.data(), &least);

  Eigen::VectorXd slope;
  violation(problem, conflict.x, slope);
  conflict.rows = problem.violations(conflict.x, tolerance);
  if (conflict.rows.empty()) return conflict;
  // Away from a bound the slope is 0 at the least violation, up to where the search ended.
  const double push = 0.05 * slope.cwiseAbs().maxCoeff();
  for (int i = 0; i < problem.variables(); ++i) {
    const bool low = conflict.x[i] <= problem.lower()[i] + 1e-9 && slope[i] > push;
    const bool high = conflict.x[i] >= problem.upper()[i] - 1e-9 && slope[i] < -push;
    if (low || high) conflict.limits.push_back(problem.variableName(i) + (low ? " (lower)" : " (upper)"));
  }
  return conflict;
}

}  // namespace fcl_stpbv
