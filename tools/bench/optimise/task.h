// The tasks for optimisers: boxes that move freely, a quadratic cost and rows d >= 0.
#pragma once

#include "tools/bench/control/scene.h"

namespace fcl_stpbv::benchmark {

/// A program in the coordinates x. For each knot (a moment of a trajectory), x has the coordinates of all
/// free bodies: position and angles about y, x and z (m, rad). With `clearance`, the last coordinate is the
/// distance that every row must have (m).
struct Task {
  std::string name;
  Scene scene;  ///< the bodies, and the pairs whose distances are rows
  int knots = 1;
  bool clearance = false;
  /// The cost is x'Qx/2 + c'x + constant.
  Eigen::MatrixXd Q;
  Eigen::VectorXd c;
  double constant = 0;
  Eigen::VectorXd lower, upper, start;

  double cost(const Eigen::VectorXd& x) const { return 0.5 * x.dot(Q * x) + c.dot(x) + constant; }
};

const std::vector<std::string>& tasks();

/// @throws Error for an unknown name.
Task makeTask(const std::string& name, int seed);

}  // namespace fcl_stpbv::benchmark
