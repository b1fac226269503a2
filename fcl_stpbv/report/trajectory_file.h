// Way points of a robot from a CSV or a JSON file.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fcl_stpbv/robot/kinematics.h"

namespace fcl_stpbv::report {

struct Trajectory {
  /// At least two, each with all coordinates; straight lines between them.
  std::vector<Eigen::VectorXd> points;
  /// Of each point, growing (s); 0, 1, 2 ... if the file has none.
  std::vector<double> time;
  /// Whether the file has times.
  bool timed = false;
  /// Subtracted from the file's times (s): the first time, if it is beyond 1e6 as the stamps of a clock are;
  /// otherwise 0.
  double start = 0;
};

/// CSV: a line with the names of coordinates (as `Kinematics::names()`), with or without `time`, then one
/// line for each way point. JSON: `{"joints": [names], "points": [[values]], "time": [seconds]}`, `time`
/// optional. Or a trajectory_msgs/JointTrajectory of ROS, of which positions and times are read.
/// Coordinates that are not named keep their values in `rest`. @throws Error naming the file, the line or
/// key, and what would work.
Trajectory readTrajectory(const std::string& path, const Kinematics& kinematics, const Eigen::VectorXd& rest);

/// A warning if a continuous, planar or floating joint rotates by more than half a turn from one way point to
/// the next; else "". That happens with angles that were wrapped to -pi ... pi, and with rotation vectors
/// kept within pi. Many robots then take the shorter way, which is not the motion that is checked. `name` is
/// the argument that gave the trajectory.
std::string turnWarning(const std::string& name, const Trajectory& trajectory, const Kinematics& kinematics);

}  // namespace fcl_stpbv::report
