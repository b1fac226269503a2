// Equalities of which some follow from others, as most of a planar arm's do: as many combinations of them as
// are independent.
#pragma once

#include "fcl_stpbv/posture/problem.h"

namespace fcl_stpbv::detail {

/// Orthonormal combinations of a Jacobian's rows, one per column, that span all they move: as many as the
/// rows' rank, where what moves by `least` or less per unit of every variable counts as still. The identity
/// where the rows are independent.
Eigen::MatrixXd independentCombinations(const RowMatrix& jacobian, double least);

}  // namespace fcl_stpbv::detail
