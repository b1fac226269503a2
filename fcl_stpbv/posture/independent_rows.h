// Removes linear dependence from equality constraints: replaces them by independent linear combinations. Some
// constraints often follow from others, for example most constraints of a planar arm.
#pragma once

#include "fcl_stpbv/posture/problem.h"

namespace fcl_stpbv::detail {

/// Orthonormal linear combinations of a Jacobian's rows, one per column, that span their range. Their number
/// is the rank of the rows; a combination that changes by `least` or less per unit of every variable counts
/// as zero. The identity if the rows are independent.
Eigen::MatrixXd independentCombinations(const RowMatrix& jacobian, double least);

}  // namespace fcl_stpbv::detail
