// IPOPT behind solver.h.
#include "tools/bench/optimise/ipopt.h"

#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>

namespace fcl_stpbv::benchmark {
namespace {

using Eigen::Map;
using Eigen::VectorXd;
using ConstMap = Map<const VectorXd>;
constexpr double kNone = 1e20;  // IPOPT's infinity

class Program : public Ipopt::TNLP {
 public:
  Program(SmoothProgram& nlp, const VectorXd& start, bool curvature, Solution& solution)
      : nlp_(nlp), start_(start), curvature_(curvature), solution_(solution) {}

  bool get_nlp_info(int& n, int& m, int& jacobian, int& hessian, IndexStyleEnum& style) override {
    n = static_cast<int>(nlp_.lower().size());
    m = static_cast<int>(nlp_.most().size());
    jacobian = static_cast<int>(nlp_.jacobianPlaces().size());
    hessian = static_cast<int>(nlp_.hessianPlaces().size());
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(int n, double* low, double* high, int m, double* least, double* most) override {
    Map<VectorXd>(low, n) = nlp_.lower().cwiseMax(-kNone);
    Map<VectorXd>(high, n) = nlp_.upper().cwiseMin(kNone);
    std::fill(least, least + m, 0.0);
    Map<VectorXd>(most, m) = nlp_.most().cwiseMin(kNone);
    return true;
  }
  bool get_starting_point(int n, bool, double* x, bool, double*, double*, int, bool, double*) override {
    Map<VectorXd>(x, n) = start_;
    return true;
  }
  bool eval_f(int n, const double* x, bool, double& cost) override {
    cost = nlp_.cost(ConstMap(x, n));
    return true;
  }
  bool eval_grad_f(int n, const double* x, bool, double* gradient) override {
    Map<VectorXd>(gradient, n) = nlp_.costGradient(ConstMap(x, n));
    return true;
  }
  bool eval_g(int n, const double* x, bool, int m, double* rows) override {
    Map<VectorXd>(rows, m) = nlp_.values(ConstMap(x, n));
    return true;
  }
  bool eval_jac_g(int n, const double* x, bool, int, int count, int* row, int* column,
                  double* entries) override {
    if (entries)
      Map<VectorXd>(entries, count) = nlp_.jacobian(ConstMap(x, n));
    else
      structure(nlp_.jacobianPlaces(), row, column);
    return true;
  }
  bool eval_h(int n, const double* x, bool, double scale, int m, const double* weights, bool, int count,
              int* row, int* column, double* entries) override {
    if (!entries) {
      structure(nlp_.hessianPlaces(), row, column);
      return true;
    }
    nlp_.hessian(ConstMap(x, n), scale, ConstMap(weights, m), curvature_, entries_);
    Map<VectorXd>(entries, count) = entries_;
    return true;
  }
  void finalize_solution(Ipopt::SolverReturn, int n, const double* x, const double*, const double*, int,
                         const double*, const double*, double, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    solution_.x = ConstMap(x, n);
  }

 private:
  static void structure(const std::vector<SmoothProgram::Place>& places, int* row, int* column) {
    for (const SmoothProgram::Place& p : places) {
      *row++ = p.row;
      *column++ = p.column;
    }
  }

  SmoothProgram& nlp_;
  const VectorXd& start_;
  bool curvature_;
  Solution& solution_;
  VectorXd entries_;
};

}  // namespace

Solution solveByIpopt(SmoothProgram& nlp, const VectorXd& start, Solver solver, bool warm) {
  Solution solution;
  solution.x = start;
  Ipopt::SmartPtr<Ipopt::IpoptApplication> ipopt = new Ipopt::IpoptApplication();
  Ipopt::OptionsList& options = *ipopt->Options();
  options.SetIntegerValue("print_level", 0);
  options.SetStringValue("sb", "yes");
  options.SetIntegerValue("max_iter", warm ? 100 : 300);
  options.SetNumericValue("tol", 1e-8);
  options.SetIntegerValue("acceptable_iter", 0);     // only full accuracy counts as solved
  options.SetNumericValue("bound_relax_factor", 0);  // no row is violated by design
  if (solver == Solver::limited) options.SetStringValue("hessian_approximation", "limited-memory");
  if (warm) {  // start with the last barrier of the program before, and do not push its solution away from
               // its rows
    options.SetNumericValue("mu_init", 1e-6);
    for (const char* push : {"bound_push", "bound_frac", "slack_bound_push", "slack_bound_frac"})
      options.SetNumericValue(push, 1e-6);
  }
  ipopt->Initialize();
  Ipopt::SmartPtr<Ipopt::TNLP> program = new Program(nlp, start, solver != Solver::gaussNewton, solution);
  solution.converged = ipopt->OptimizeTNLP(program) == Ipopt::Solve_Succeeded;
  return solution;
}

}  // namespace fcl_stpbv::benchmark
