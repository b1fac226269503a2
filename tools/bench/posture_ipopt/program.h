// A posture's problem in the form that IPOPT needs.
#pragma once

#include <vector>

#include "tools/bench/optimise/program.h"
#include "tools/bench/optimise/solver.h"
#include "tools/bench/posture_ipopt/hessian.h"

namespace fcl_stpbv::benchmark {

/// The problem with all equalities, some inequalities and half the cost, as solveBySlsqp() has it. All
/// derivatives are dense: with these sizes this takes no longer.
class PostureProgram : public SmoothProgram {
 public:
  PostureProgram(PostureProblem& problem, PostureHessian& hessian, std::vector<int> inequalities);

  const Vector& lower() const override { return problem_.lower(); }
  const Vector& upper() const override { return problem_.upper(); }
  Vector most() const override;
  double cost(const Vector& x) override { return problem_.evaluate(x).cost / 2; }
  Vector costGradient(const Vector& x) override { return problem_.evaluate(x).costGradient / 2; }
  const Vector& values(const Vector& x) override;
  const Vector& jacobian(const Vector& x) override;
  void hessian(const Vector& x, double scale, const Vector& weights, bool curvature,
               Vector& entries) override;

 private:
  PostureProblem& problem_;
  PostureHessian& hessian_;
  std::vector<int> inequalities_;
  Vector values_, jacobian_;
  Eigen::MatrixXd lower_;
};

struct PostureSolution {
  Eigen::VectorXd x;
  long hessians = 0;
};

/// Like solveBySlsqp(), the program begins with the inequalities that have little slack; those that its
/// solution violates are added, and IPOPT continues from there.
PostureSolution solveByIpopt(PostureProblem& problem, PostureHessian& hessian, const Eigen::VectorXd& start,
                             Solver solver);

}  // namespace fcl_stpbv::benchmark
