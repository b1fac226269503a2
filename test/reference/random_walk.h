// Random walks of a robot, for tests and benchmarks of its distances.
#pragma once

#include <Eigen/Core>

#include "fcl_stpbv/robot/kinematics.h"

namespace fcl_stpbv::test {

/// Shares of the joints' ranges: steps as of a controller, and configurations that have little in common.
constexpr double kSmallStep = 1e-3, kRandomStep = 0.5;

/// One configuration per column, within the limits and within pi of zero. From the neutral one on, each
/// joint moves by a random step, at most `step` of its range.
Eigen::MatrixXd randomWalk(const Kinematics& kinematics, double step, int count);

}  // namespace fcl_stpbv::test
