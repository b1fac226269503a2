// Solves the problem by NLopt's SLSQP (Kraft 1988), with a small active set of rows:
// 1. Start with the inequalities that have little slack.
// 2. Use independent combinations of the equalities, because dependent ones make SLSQP's matrix singular.
// 3. If an iterate violates a row that is not included, restart from there with the row.
// 4. Stop a search whose violations no longer fall, or whose line search does not end.
#include <nlopt.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <memory>
#include <vector>

#include "fcl_stpbv/number_check.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/posture/independent_rows.h"

namespace fcl_stpbv {
namespace {

using namespace detail;

using ConstMap = Eigen::Map<const Eigen::VectorXd>;
using Map = Eigen::Map<Eigen::VectorXd>;

class Slsqp {
 public:
  Slsqp(PostureProblem& problem, const SolverOptions& options) : problem_(problem), options_(options) {}

  SolverOutcome run(const Eigen::VectorXd& start) {
    const auto begin = std::chrono::steady_clock::now();
    best_.x = start;
    Eigen::VectorXd x = start;
    select(x);
    for (;;) {
      grown_ = false;
      const double left = options_.maxSeconds -
                          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      const nlopt_result result = optimise(x, left);
      if (failure_) std::rethrow_exception(failure_);
      if (!grown_ || stopped_) {
        best_.x = x;
        best_.status = stopped_ ? "stopped" : stuck_ ? "stuck" : nameOf(result);
        return best_;
      }
      select(grownAt_);
      x = iterate_;
    }
  }

 private:
  struct Delete {
    void operator()(nlopt_opt opt) const { nlopt_destroy(opt); }
  };

  static std::string nameOf(nlopt_result result) {
    switch (result) {
      case NLOPT_FTOL_REACHED:
      case NLOPT_XTOL_REACHED:
      case NLOPT_SUCCESS:
        return "converged";
      case NLOPT_ROUNDOFF_LIMITED:
        return "no further progress";
      case NLOPT_MAXEVAL_REACHED:
      case NLOPT_FORCED_STOP:
        return "too many iterations";
      case NLOPT_MAXTIME_REACHED:
        return "out of time";
      default:
        return "the solver failed";
    }
  }

  // Includes the inequalities that have little slack at x.
  void select(const Eigen::VectorXd& x) {
    const PostureValues& values = problem_.evaluate(x);
    chosen_.resize(static_cast<std::size_t>(problem_.inequalities()), false);
    active_.clear();
    for (int i = 0; i < problem_.inequalities(); ++i) {
      chosen_[static_cast<std::size_t>(i)] =
          chosen_[static_cast<std::size_t>(i)] || values.atLeast[i] < options_.activation;
      if (chosen_[static_cast<std::size_t>(i)]) active_.push_back(i);
    }
  }

  // Computes the independent combinations of the equalities at x. A combination that changes by less than its
  // tolerance per unit of every variable, or only with fixed variables, cannot be controlled. It is only
  // checked at the end.
  void combine(const Eigen::VectorXd& x) {
    if (problem_.equalities() == 0) return;
    RowMatrix jacobian = problem_.evaluate(x).equalJacobian;
    for (int i = 0; i < problem_.variables(); ++i)
      if (problem_.lower()[i] == problem_.upper()[i]) jacobian.col(i).setZero();
    combinations_ = independentCombinations(jacobian, options_.tolerance);
  }

  nlopt_result optimise(Eigen::VectorXd& x, double seconds) {
    const unsigned n = static_cast<unsigned>(problem_.variables());
    const std::unique_ptr<nlopt_opt_s, Delete> opt(nlopt_create(NLOPT_LD_SLSQP, n));
    opt_ = opt.get();
    nlopt_set_lower_bounds(opt_, problem_.lower().data());
    nlopt_set_upper_bounds(opt_, problem_.upper().data());
    nlopt_set_min_objective(opt_, &Slsqp::objective, this);
    combine(x);
    if (combinations_.cols() > 0) {
      // If no combination is off by more than this, no row is off by more than its tolerance.
      const double most = options_.tolerance / combinations_.cwiseAbs().rowwise().sum().maxCoeff();
      const std::vector<double> tolerances(static_cast<std::size_t>(combinations_.cols()), most);
      nlopt_add_equality_mconstraint(opt_, static_cast<unsigned>(combinations_.cols()), &Slsqp::equalities,
                                     this, tolerances.data());
    }
    if (!active_.empty()) {
      const std::vector<double> tolerances(active_.size(), options_.tolerance);
      nlopt_add_inequality_mconstraint(opt_, static_cast<unsigned>(active_.size()), &Slsqp::inequalities,
                                       this, tolerances.data());
    }
    nlopt_set_ftol_rel(opt_, options_.costTolerance);
    nlopt_set_xtol_rel(opt_, 1e-9);
    nlopt_set_maxtime(opt_, std::max(1e-3, seconds));
    double cost;
    return nlopt_optimize(opt_, x.data(), &cost);
  }

  // Part of a callback. No exception may pass through NLopt, which is written in C: it ends the search, and
  // run() throws it again.
  template <class Part>
  void guarded(const Part& part) {
    try {
      part();
    } catch (...) {
      if (!failure_) failure_ = std::current_exception();
      nlopt_force_stop(opt_);
    }
  }

  // SLSQP begins with the identity as the Hessian: half the cost has just that along each joint of weight 1.
  static double objective(unsigned n, const double* x, double* gradient, void* self) {
    Slsqp& s = *static_cast<Slsqp*>(self);
    double cost = kInfinity;
    s.guarded([&] {
      const PostureValues& values = s.problem_.evaluate(ConstMap(x, n));
      if (gradient) {
        Map(gradient, n) = values.costGradient / 2;
        s.iterate_ = values.x;
        ++s.best_.iterations;
        s.line_ = 0;
        s.watch(values);
      } else {
        s.watchLine();
      }
      s.grow(values);
      cost = values.cost / 2;
    });
    return cost;
  }

  // Stops a search whose violations no longer fall; SLSQP would continue for hundreds of iterations.
  void watch(const PostureValues& values) {
    constexpr double kFar = 1e-3;  // m, rad; a search that is nearer may well alternate between two sides
    constexpr int kPatience = 15;
    const double miss = std::max(values.equal.size() ? values.equal.cwiseAbs().maxCoeff() : 0.0,
                                 values.atLeast.size() ? -values.atLeast.minCoeff() : 0.0);
    if (miss < 0.9 * leastMiss_) {
      leastMiss_ = miss;
      leastAt_ = best_.iterations;
    }
    stuck_ = leastMiss_ > kFar && best_.iterations > leastAt_ + kPatience;
    stopped_ = options_.stop && options_.stop();
    if (stopped_ || stuck_ || best_.iterations >= options_.maxIterations) nlopt_force_stop(opt_);
  }

  // Stops a line search that does not end. NLopt's line search takes at most 11 points. But where the merit
  // is infinite or NaN, as with rows that contradict each other, it makes its step shorter for ever.
  void watchLine() {
    constexpr int kLongest = 30;
    stuck_ = ++line_ > kLongest;
    if (stuck_) nlopt_force_stop(opt_);
  }

  // Stops the solver for a restart with more rows, if a row is violated that is not included.
  void grow(const PostureValues& values) {
    if (stuck_ || best_.iterations >= options_.maxIterations) return;
    for (int i = 0; i < problem_.inequalities(); ++i) {
      if (values.atLeast[i] >= -options_.tolerance || chosen_[static_cast<std::size_t>(i)]) continue;
      grown_ = true;
      chosen_[static_cast<std::size_t>(i)] = true;
    }
    if (!grown_) return;
    grownAt_ = values.x;
    nlopt_force_stop(opt_);
  }

  static void equalities(unsigned m, double* result, unsigned n, const double* x, double* jacobian,
                         void* self) {
    Slsqp& s = *static_cast<Slsqp*>(self);
    s.guarded([&] {
      const PostureValues& values = s.problem_.evaluate(ConstMap(x, n));
      Map(result, m) = s.combinations_.transpose() * values.equal;
      if (jacobian)
        Eigen::Map<RowMatrix>(jacobian, m, n) = s.combinations_.transpose() * values.equalJacobian;
    });
  }

  static void inequalities(unsigned m, double* result, unsigned n, const double* x, double* jacobian,
                           void* self) {
    Slsqp& s = *static_cast<Slsqp*>(self);
    s.guarded([&] {
      const PostureValues& values = s.problem_.evaluate(ConstMap(x, n));
      for (unsigned i = 0; i < m; ++i) {
        result[i] = -values.atLeast[s.active_[i]];
        if (jacobian)
          Eigen::Map<RowMatrix>(jacobian, m, n).row(i) = -values.atLeastJacobian.row(s.active_[i]);
      }
    });
  }

  PostureProblem& problem_;
  const SolverOptions& options_;
  nlopt_opt opt_ = nullptr;
  Eigen::MatrixXd combinations_;  // of the equalities in the model, one per column
  std::vector<int> active_;
  std::vector<bool> chosen_;
  bool grown_ = false, stuck_ = false, stopped_ = false;
  double leastMiss_ = kInfinity;  // least value of the largest violation in any iteration so far
  int leastAt_ = 0;
  int line_ = 0;  // points without a gradient since the last iterate
  Eigen::VectorXd iterate_, grownAt_;
  std::exception_ptr failure_;  // the first one of a callback
  SolverOutcome best_;
};

}  // namespace

SolverOutcome solveBySlsqp(PostureProblem& problem, const Eigen::VectorXd& start,
                           const SolverOptions& options) {
  requireSize("solveBySlsqp", "start", start.size(), problem.variables());
  if (problem.variables() == 0) return {start, 0, "converged"};
  return Slsqp(problem, options).run(start);
}

}  // namespace fcl_stpbv
