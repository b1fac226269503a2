// Converts a named posture to a configuration: takes its values, and checks that they fit the joints without
// coordinates (fixed and mimic joints).
#include <algorithm>
#include <cmath>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/joint_freedoms.h"
#include "fcl_stpbv/robot/kinematics.h"

namespace fcl_stpbv {

using namespace detail;

Eigen::VectorXd Kinematics::configuration(const Srdf::State& state, Eigen::VectorXd rest) const {
  Eigen::VectorXd& q = rest;
  if (q.size() != size())
    throw Error("posture '" + state.name + "': the rest has " + std::to_string(q.size()) +
                " values, the robot has " + std::to_string(size()) + " coordinates");
  const auto known = [&](const auto& use) {
    for (const auto& [name, values] : state.joints) {
      const int joint = robot_->joint(name);
      if (joint < 0) continue;  // a virtual joint, or a joint of another variant of the robot
      const std::string where = "posture '" + state.name + "': joint '" + name + "' ";
      const JointModel& model = robot_->joints[at(joint)];
      const int count = std::max(1, freedoms(model.type));
      if (static_cast<int>(values.size()) != count)
        throw Error(where + "has " + std::to_string(values.size()) + " values, expected " +
                    std::to_string(count));
      use(where, model, coordinateOf_[at(joint)], values);
    }
  };
  known([&](const std::string&, const JointModel&, int first, const std::vector<double>& values) {
    for (std::size_t k = 0; first >= 0 && k < values.size(); ++k) q[first + static_cast<int>(k)] = values[k];
  });
  // Mimic joints follow other joints, and fixed joints do not move. If the state gives them another value, it
  // means another posture than the robot can have.
  known([&](const std::string& where, const JointModel& model, int first, const std::vector<double>& values) {
    constexpr double kOff = 1e-3;  // tolerance for values written with few digits (rad or m)
    if (first >= 0) return;
    const double own = model.mimic ? steps_[at(stepOf_[at(model.child)])].value(q) : 0.0;
    const bool turns = model.type == JointType::revolute || model.type == JointType::continuous;
    const double off = turns ? std::remainder(values[0] - own, kTwoPi) : values[0] - own;
    if (std::abs(off) <= kOff) return;
    throw Error(where + "cannot be " + toDecimal(values[0]) + ": it " +
                (model.mimic ? "follows '" + robot_->joints[at(model.mimic->joint)].name + "' and is " +
                                   toDecimal(own) + " then; give that joint's value"
                             : "is fixed; leave it out"));
  });
  return rest;
}

}  // namespace fcl_stpbv
