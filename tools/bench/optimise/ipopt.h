// IPOPT, in a file of its own because its headers need special flags.
#pragma once

#include "tools/bench/optimise/solver.h"

namespace fcl_stpbv::benchmark {

Solution solveByIpopt(SmoothProgram& program, const Eigen::VectorXd& start, Solver solver, bool warm);

}  // namespace fcl_stpbv::benchmark
