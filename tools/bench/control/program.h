// The quadratic program of one tick, solved exactly.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fcl_stpbv::benchmark {

/// min x'Hx/2 - f'x subject to A x >= b, with H positive definite, by Dantzig's pivoting of the dual (Bullet,
/// after ODE). The active rows are found exactly, and the rest is one linear solve. A row's multiplier is at
/// most `kPenalty`, so programs without a solution violate the rows that cost least.
class Program {
 public:
  static constexpr double kPenalty = 1e3;

  /// Returns false if the pivoting failed; then x is the solution without rows.
  bool solve(const Eigen::MatrixXd& H, const Eigen::VectorXd& f, const Eigen::MatrixXd& A,
             const Eigen::VectorXd& b, Eigen::VectorXd& x);
  /// The multipliers of the last solution, one for each row.
  const std::vector<double>& multipliers() const { return multiplier_; }

 private:
  std::vector<double> matrix_, side_, multiplier_, slack_, low_, high_;
  std::vector<int> free_;
};

}  // namespace fcl_stpbv::benchmark
