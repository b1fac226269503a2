// NLopt behind solver.h.
#include "tools/bench/optimise/solver.h"

#include <nlopt.h>

#include <memory>

#include "tools/bench/optimise/ipopt.h"

namespace fcl_stpbv::benchmark {
namespace {

using Eigen::Map;
using Eigen::VectorXd;
using ConstMap = Map<const VectorXd>;

struct Delete {
  void operator()(nlopt_opt opt) const { nlopt_destroy(opt); }
};
using Optimiser = std::unique_ptr<nlopt_opt_s, Delete>;

double cost(unsigned n, const double* x, double* gradient, void* self) {
  const Task& task = static_cast<Nlp*>(self)->task();
  if (gradient) Map<VectorXd>(gradient, n) = task.Q * ConstMap(x, n) + task.c;
  return task.cost(ConstMap(x, n));
}

// NLopt requires rows that are at most 0.
void rows(unsigned m, double* result, unsigned n, const double* x, double* jacobian, void* self) {
  Nlp& nlp = *static_cast<Nlp*>(self);
  Map<VectorXd>(result, m) = -nlp.values(ConstMap(x, n));
  if (!jacobian) return;
  const VectorXd& entries = nlp.jacobian(ConstMap(x, n));
  Map<VectorXd>(jacobian, static_cast<Eigen::Index>(m) * n).setZero();
  for (std::size_t k = 0; k < nlp.jacobianPlaces().size(); ++k) {
    const Nlp::Place& p = nlp.jacobianPlaces()[k];
    jacobian[static_cast<std::size_t>(p.row) * n + static_cast<std::size_t>(p.column)] =
        -entries[static_cast<Eigen::Index>(k)];
  }
}

void stopAt(nlopt_opt opt, double x, double f, int most) {
  nlopt_set_xtol_rel(opt, x);
  nlopt_set_ftol_rel(opt, f);
  nlopt_set_maxeval(opt, most);
}

Solution solveByNlopt(Nlp& nlp, const VectorXd& start, Solver solver) {
  const unsigned n = static_cast<unsigned>(nlp.variables());
  const Optimiser opt(nlopt_create(solver == Solver::slsqp ? NLOPT_LD_SLSQP : NLOPT_AUGLAG, n));
  nlopt_set_lower_bounds(opt.get(), nlp.task().lower.data());
  nlopt_set_upper_bounds(opt.get(), nlp.task().upper.data());
  nlopt_set_min_objective(opt.get(), cost, &nlp);
  const std::vector<double> tolerance(static_cast<std::size_t>(nlp.rows()), 1e-9);
  nlopt_add_inequality_mconstraint(opt.get(), static_cast<unsigned>(nlp.rows()), rows, &nlp,
                                   tolerance.data());
  // Similar to IPOPT's 1e-8 for the gradient: the cost is quadratic, so its change is about the square of x's
  // change.
  stopAt(opt.get(), 1e-9, 1e-13, 3000);
  if (solver == Solver::augmented) {
    const Optimiser inner(nlopt_create(NLOPT_LD_LBFGS, n));
    stopAt(inner.get(), 1e-9, 1e-13, 1000);
    nlopt_set_local_optimizer(opt.get(), inner.get());
  }
  Solution solution;
  solution.x = start;
  double least;
  const nlopt_result result = nlopt_optimize(opt.get(), solution.x.data(), &least);
  solution.converged = result > 0 && result != NLOPT_MAXEVAL_REACHED;
  return solution;
}

}  // namespace

Solution solve(Nlp& nlp, const VectorXd& start, Solver solver, bool warm) {
  return solver == Solver::slsqp || solver == Solver::augmented ? solveByNlopt(nlp, start, solver)
                                                                : solveByIpopt(nlp, start, solver, warm);
}

}  // namespace fcl_stpbv::benchmark
