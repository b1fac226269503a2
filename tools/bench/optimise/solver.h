// The optimisers that are compared: IPOPT with three kinds of second derivatives, and two methods of NLopt.
#pragma once

#include "tools/bench/optimise/nlp.h"

namespace fcl_stpbv::benchmark {

enum class Solver {
  exact,        ///< IPOPT with the Hessian of the Lagrangian
  gaussNewton,  ///< IPOPT without the rows' curvature
  limited,      ///< IPOPT's own limited-memory approximation (L-BFGS)
  slsqp,        ///< NLopt's SLSQP
  augmented     ///< NLopt's augmented Lagrangian over its L-BFGS
};

struct Solution {
  Eigen::VectorXd x;
  bool converged = false;  ///< whether the solver reports convergence
};

/// `warm`: the start is close to a solution, for example that of a neighbouring program.
Solution solve(Nlp& nlp, const Eigen::VectorXd& start, Solver solver, bool warm = false);

}  // namespace fcl_stpbv::benchmark
