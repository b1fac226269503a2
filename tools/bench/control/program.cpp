// Solves the program in three steps:
// 1. Compute the minimum without rows, by Cholesky.
// 2. If it violates a row, solve the dual, a complementarity problem, by Bullet's btSolveDantzigLCP.
// 3. Move the minimum by the rows' multipliers.
#include "tools/bench/control/program.h"

#include <BulletDynamics/MLCPSolvers/btDantzigLCP.h>

#include <Eigen/Cholesky>

namespace fcl_stpbv::benchmark {

bool Program::solve(const Eigen::MatrixXd& H, const Eigen::VectorXd& f, const Eigen::MatrixXd& A,
                    const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  const Eigen::LLT<Eigen::MatrixXd> factor(H);
  x = factor.solve(f);
  const std::size_t rows = static_cast<std::size_t>(b.size());
  multiplier_.assign(rows, 0);
  if (rows == 0 || (A * x - b).minCoeff() >= 0) return true;
  const Eigen::MatrixXd moved = factor.solve(A.transpose());
  Eigen::MatrixXd dual = A * moved;
  // Keeps the dual solvable if rows depend on each other. A row then gives way by 1e-9 times its multiplier.
  dual.diagonal().array() += 1e-9;
  matrix_.assign(dual.data(), dual.data() + dual.size());
  const Eigen::VectorXd side = b - A * x;
  side_.assign(side.data(), side.data() + side.size());
  slack_.assign(rows, 0);
  low_.assign(rows, 0);
  high_.assign(rows, kPenalty);
  free_.assign(rows, -1);
  static thread_local btDantzigScratchMemory scratch;
  if (!btSolveDantzigLCP(static_cast<int>(rows), matrix_.data(), multiplier_.data(), side_.data(),
                         slack_.data(), 0, low_.data(), high_.data(), free_.data(), scratch))
    return false;
  x += moved * Eigen::Map<const Eigen::VectorXd>(multiplier_.data(), b.size());
  return true;
}

}  // namespace fcl_stpbv::benchmark
