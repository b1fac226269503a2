// The range of the Jacobian, by a QR decomposition with column pivoting (Businger and Golub 1965).
#include "fcl_stpbv/posture/independent_rows.h"

#include <Eigen/QR>

namespace fcl_stpbv::detail {

Eigen::MatrixXd independentCombinations(const RowMatrix& jacobian, double least) {
  const Eigen::Index rows = jacobian.rows();
  if (jacobian.size() == 0) return Eigen::MatrixXd(rows, 0);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(jacobian);
  const Eigen::Index rank = (qr.matrixQR().diagonal().array().abs() > least).count();
  if (rank == rows) return Eigen::MatrixXd::Identity(rows, rows);
  return qr.householderQ() * Eigen::MatrixXd::Identity(rows, rank);
}

}  // namespace fcl_stpbv::detail
