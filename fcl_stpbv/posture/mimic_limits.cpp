// A joint that follows another one with multiplier m and offset b keeps its limits [l, u] if the other one
// stays between (l - b) / m and (u - b) / m. Chains of mimic joints are already resolved to the joint that
// moves (Mimic).
#include "fcl_stpbv/posture/mimic_limits.h"

#include <algorithm>
#include <utility>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {
namespace {

// Limits that should meet in one value may miss each other by rounding, if they are written with few digits
// or divided.
constexpr double kMeet = 1e-9;

// The limits that all followers of one coordinate allow, and the follower that sets each limit.
struct Followers {
  double low = -kInfinity, high = kInfinity;
  std::string lowBy, highBy;
};

std::string limitsOf(const std::string& joint, double low, double high) {
  return "'" + joint + "' keeps within " + toDecimal(low) + " and " + toDecimal(high);
}

void addFollower(const RobotModel& robot, const JointModel& joint, Followers& all) {
  const Mimic& mimic = *joint.mimic;
  if (mimic.multiplier == 0) {
    if (mimic.offset >= joint.lower - kMeet && mimic.offset <= joint.upper + kMeet) return;
    throw Error(robot.path + ": joint " + limitsOf(joint.name, joint.lower, joint.upper) + ", but mimics '" +
                robot.joints[at(mimic.joint)].name + "' with multiplier 0 and stays at its offset " +
                toDecimal(mimic.offset) + "; change its limits or its offset");
  }
  double low = (joint.lower - mimic.offset) / mimic.multiplier;
  double high = (joint.upper - mimic.offset) / mimic.multiplier;
  if (mimic.multiplier < 0) std::swap(low, high);
  if (low > all.low) {
    all.low = low;
    all.lowBy = joint.name;
  }
  if (high < all.high) {
    all.high = high;
    all.highBy = joint.name;
  }
}

}  // namespace

void keepMimicLimits(const Kinematics& kinematics, NamedLimits lower, NamedLimits upper) {
  const RobotModel& robot = kinematics.robot();
  for (const JointModel& leader : robot.joints) {
    const int i = kinematics.coordinate(leader.name);
    if (i < 0) continue;
    Followers all;
    for (const JointModel& joint : robot.joints)
      if (joint.mimic && joint.type != JointType::continuous &&
          &robot.joints[at(joint.mimic->joint)] == &leader)
        addFollower(robot, joint, all);
    double low = lower.values[i], high = upper.values[i];
    if (leader.type == JointType::continuous && (all.low > low || all.high < high)) {
      const double turn = high - low;  // any full turn will do, so take one that the followers allow
      low = std::max(all.low, std::min(low, all.high - turn));
      high = std::min(all.high, low + turn);
    }
    low = std::max(low, all.low);
    high = std::min(high, all.high);
    if (low > high + kMeet) {
      std::string message = robot.path + ": joint " +
                            limitsOf(leader.name, lower.values[i], upper.values[i]) +
                            ", but the joints that mimic it leave no allowed value: ";
      if (!all.lowBy.empty()) message += "'" + all.lowBy + "' needs " + toDecimal(all.low) + " or more, ";
      if (!all.highBy.empty()) message += "'" + all.highBy + "' needs " + toDecimal(all.high) + " or less, ";
      throw Error(message + "by their own limits; change limits, multiplier or offset");
    }
    if (low > high) low = high = (low + high) / 2;
    if (low == all.low && low > lower.values[i]) lower.by[at(i)] = all.lowBy;
    if (high == all.high && high < upper.values[i]) upper.by[at(i)] = all.highBy;
    lower.values[i] = low;
    upper.values[i] = high;
  }
}

std::vector<std::string> impossibleMimics(const Kinematics& kinematics) {
  Eigen::VectorXd lower = kinematics.lower(), upper = kinematics.upper();
  std::vector<std::string> lowerBy(at(kinematics.size())), upperBy = lowerBy;
  try {
    keepMimicLimits(kinematics, {lower, lowerBy}, {upper, upperBy});
  } catch (const Error& error) {
    return {error.what() +
            std::string(". Until then every verdict is over postures that the robot cannot have.")};
  }
  return {};
}

}  // namespace fcl_stpbv::detail
