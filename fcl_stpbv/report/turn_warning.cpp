// Steps of more than half a turn: a real joint may take the other way, which is not checked.
#include <cmath>

#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/report/trajectory_file.h"
#include "fcl_stpbv/robot/joint_freedoms.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

// Number of a joint's coordinates, its last ones, that are angles and return after a whole turn: one, or the
// rotation vector of a floating joint.
int anglesOf(JointType type) {
  switch (type) {
    case JointType::continuous:
    case JointType::planar:
      return 1;
    case JointType::floating:
      return 3;
    default:
      return 0;
  }
}

// Of all angles that rotate a body as `to` does, those nearest to `from`. They differ by whole turns about
// the same axis.
Eigen::VectorXd nearestTurn(const Eigen::VectorXd& to, const Eigen::VectorXd& from) {
  const double angle = to.norm();
  const Eigen::VectorXd axis = (angle > 0 ? to : from).normalized();
  return to + kTwoPi * std::round((from.dot(axis) - angle) / (kTwoPi)) * axis;
}

std::string joined(const Eigen::VectorXd& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + toDecimal(value);
  return text;
}

}  // namespace

std::string turnWarning(const std::string& name, const Trajectory& trajectory, const Kinematics& kinematics) {
  for (std::size_t i = 1; i < trajectory.points.size(); ++i) {
    for (const JointModel& joint : kinematics.robot().joints) {
      const int angles = anglesOf(joint.type);
      if (joint.mimic || angles == 0) continue;
      const int k = kinematics.coordinate(joint.name) + freedoms(joint.type) - angles;
      const Eigen::VectorXd last = trajectory.points[i - 1].segment(k, angles),
                            to = trajectory.points[i].segment(k, angles), nearest = nearestTurn(to, last);
      constexpr double kOff = 1e-6;  // rad; error of half a turn in few digits
      const double turn = (to - last).norm();
      if (turn <= (nearest - last).norm() + kOff) continue;
      const std::string what = angles == 1 ? kinematics.names()[at(k)] : joint.name;
      return name + ": way point " + std::to_string(i) + " (from 0): '" + what + "' turns by " +
             toDecimal(angles == 1 ? to[0] - last[0] : turn) +
             " rad, more than half a turn; this longer rotation is checked, not the short one, which would "
             "end at " +
             joined(nearest) + " rad.";
    }
  }
  return "";
}

}  // namespace fcl_stpbv::report
