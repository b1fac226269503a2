// IPOPT, apart from the rest: its headers need flags of their own.
#pragma once

#include "tools/bench/optimise/solver.h"

namespace fcl_stpbv::benchmark {

Solution solveByIpopt(Nlp& nlp, const Eigen::VectorXd& start, Solver solver, bool warm);

}  // namespace fcl_stpbv::benchmark
