// Copies a posture's values and derivatives to where IPOPT expects them.
#include "tools/bench/posture_ipopt/program.h"

#include <utility>

#include "fcl_stpbv/numbers.h"
#include "tools/bench/optimise/ipopt.h"

namespace fcl_stpbv::benchmark {

using detail::at;
using Eigen::VectorXd;

PostureProgram::PostureProgram(PostureProblem& problem, PostureHessian& hessian,
                               std::vector<int> inequalities)
    : problem_(problem), hessian_(hessian), inequalities_(std::move(inequalities)) {
  const int n = problem.variables(), rows = static_cast<int>(most().size());
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < n; ++j) jacobianPlaces_.push_back({i, j});
  for (int j = 0; j < n; ++j)
    for (int i = j; i < n; ++i) hessianPlaces_.push_back({i, j});
}

VectorXd PostureProgram::most() const {
  VectorXd most = VectorXd::Zero(problem_.equalities() + static_cast<int>(inequalities_.size()));
  most.tail(most.size() - problem_.equalities()).setConstant(detail::kInfinity);
  return most;
}

const VectorXd& PostureProgram::values(const VectorXd& x) {
  const PostureValues& all = problem_.evaluate(x);
  values_.resize(all.equal.size() + static_cast<int>(inequalities_.size()));
  values_ << all.equal, all.atLeast(inequalities_);
  return values_;
}

const VectorXd& PostureProgram::jacobian(const VectorXd& x) {
  const PostureValues& all = problem_.evaluate(x);
  RowMatrix rows(all.equal.size() + static_cast<int>(inequalities_.size()), x.size());
  rows << all.equalJacobian, all.atLeastJacobian(inequalities_, Eigen::all);
  jacobian_ = Eigen::Map<const VectorXd>(rows.data(), rows.size());
  return jacobian_;
}

void PostureProgram::hessian(const VectorXd& x, double scale, const VectorXd& weights, bool curvature,
                             VectorXd& entries) {
  ++hessians;
  VectorXd atLeast = VectorXd::Zero(problem_.inequalities());
  if (!inequalities_.empty()) atLeast(inequalities_) = weights.tail(static_cast<int>(inequalities_.size()));
  lower_.setZero(x.size(), x.size());
  if (curvature) hessian_.evaluate(x, weights.head(problem_.equalities()), atLeast, lower_);
  lower_.diagonal() += scale / 2 * problem_.costCurvature();
  entries.resize(static_cast<Eigen::Index>(hessianPlaces_.size()));
  Eigen::Index to = 0;
  for (const Place& p : hessianPlaces_) entries[to++] = lower_(p.row, p.column);
}

PostureSolution solveByIpopt(PostureProblem& problem, PostureHessian& hessian, const VectorXd& start,
                             Solver solver) {
  const SolverOptions limits;
  PostureSolution solution{start, 0};
  std::vector<char> chosen(at(problem.inequalities()), 0);
  const auto choose = [&](double slack) {
    const VectorXd values = problem.evaluate(solution.x).atLeast;
    bool more = false;
    for (int i = 0; i < problem.inequalities(); ++i) {
      if (chosen[at(i)] || !(values[i] < slack)) continue;
      chosen[at(i)] = 1;
      more = true;
    }
    return more;
  };
  choose(limits.activation);
  do {
    std::vector<int> inequalities;
    for (int i = 0; i < problem.inequalities(); ++i)
      if (chosen[at(i)]) inequalities.push_back(i);
    PostureProgram program(problem, hessian, inequalities);
    const VectorXd from = solution.x;
    solution.x = solveByIpopt(program, from, solver, false).x;
    solution.hessians += program.hessians;
  } while (choose(-limits.tolerance));
  return solution;
}

}  // namespace fcl_stpbv::benchmark
