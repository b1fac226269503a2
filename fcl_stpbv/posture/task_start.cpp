// The start and the cost of a task: finds the coordinates that it names. The pose of a base that does not
// move is taken into account by moving everything else by the inverse.
#include "fcl_stpbv/posture/task_start.h"

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/joint_freedoms.h"
#include "fcl_stpbv/robot/joint_names.h"
#include "fcl_stpbv/robot/near_name.h"

namespace fcl_stpbv {
namespace {

// One coordinate by its own name, or all coordinates of a joint by the joint's name.
std::vector<int> coordinatesNamed(const std::string& name, const Kinematics& kinematics) {
  const std::vector<std::string>& names = kinematics.names();
  const auto own = std::find(names.begin(), names.end(), name);
  if (own != names.end()) return {static_cast<int>(own - names.begin())};
  std::vector<int> found;
  const int joint = kinematics.robot().joint(name), first = kinematics.coordinate(name);
  for (int k = 0; first >= 0 && k < detail::freedoms(kinematics.robot().joints[detail::at(joint)].type); ++k)
    found.push_back(first + k);
  return found;
}

// Checks the base's pose. A state gives the base's pose relative to its parent_frame, which a task does not
// know.
void requireBasePose(const PostureTask& task, const PostureScene& scene) {
  const bool given = task.basePose.matrix() != Eigen::Matrix4d::Identity();
  if (given || task.seenFromBase || task.state.empty() || !scene.srdf) return;
  const std::string where = task.path + ": start.state";
  const Srdf::State state = detail::within(where, [&] { return scene.srdf->state(task.state); });
  if (scene.srdf->movesBase(state))
    throw Error(where + ": '" + task.state + "' places the base by the virtual joint '" +
                scene.srdf->baseJoint +
                "', and start.base leaves it at the origin; give the base's pose in start.base, or name a "
                "state without that joint");
}

bool endsWith(const std::string& name, const std::string& end) {
  return name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
}

// Removes full turns that make no difference to the posture: from rotations, and from continuous joints that
// no other joint follows. The search keeps these coordinates within half a turn.
void takeOffTurns(const Kinematics& kinematics, Eigen::VectorXd& q) {
  const std::vector<JointModel>& joints = kinematics.robot().joints;
  const auto isFollowed = [&](int leader) {
    return std::any_of(joints.begin(), joints.end(),
                       [&](const JointModel& joint) { return joint.mimic && joint.mimic->joint == leader; });
  };
  for (int i = 0; i < kinematics.size(); ++i) {
    const std::string& name = kinematics.names()[static_cast<std::size_t>(i)];
    const int joint = kinematics.robot().joint(name);
    if (joint >= 0
            ? joints[static_cast<std::size_t>(joint)].type == JointType::continuous && !isFollowed(joint)
            : endsWith(name, "/angle")) {
      q[i] = std::remainder(q[i], detail::kTwoPi);
    } else if (joint < 0 && endsWith(name, "/rx")) {
      const double angle = q.segment<3>(i).norm();
      if (angle > detail::kPi) q.segment<3>(i) *= std::remainder(angle, detail::kTwoPi) / angle;
    }
  }
}

[[noreturn]] void refuseJoint(const std::string& where, const std::string& joint,
                              const Kinematics& kinematics) {
  const RobotModel& robot = kinematics.robot();
  const int known = robot.joint(joint);
  if (known >= 0 && robot.joints[static_cast<std::size_t>(known)].mimic) {
    const int leader = robot.joints[static_cast<std::size_t>(known)].mimic->joint;
    throw Error(where + ": '" + joint + "' follows '" + robot.joints[static_cast<std::size_t>(leader)].name +
                "'; give that joint's value");
  }
  throw Error(where + ": the robot has no joint '" + joint + "' of its own" +
              detail::didYouMean(joint, detail::valueNames(kinematics)));
}

}  // namespace

PostureCost detail::costOf(const PostureTask& task, const Kinematics& kinematics,
                           const Eigen::VectorXd& start) {
  PostureCost cost = quarterCost(kinematics);
  if (task.towardsStart) cost.reference = start;
  // The names are in alphabetical order: a coordinate such as "p/y" comes after its joint "p". So its own
  // weight counts.
  for (const auto& [joint, weight] : task.weights) {
    const std::vector<int> named = coordinatesNamed(joint, kinematics);
    if (named.empty()) refuseJoint(task.path + ": cost.weights", joint, kinematics);
    for (const int i : named) cost.weights[i] = weight;
  }
  return cost;
}

Eigen::VectorXd startOf(const PostureTask& task, const PostureScene& scene, const Kinematics& kinematics) {
  if (!task.state.empty() && !scene.srdf)
    throw Error(task.path + ": start.state: '" + task.state + "' needs an SRDF; give --srdf");
  Eigen::VectorXd q = kinematics.neutral();
  if (!task.state.empty())
    q = detail::within(task.path + ": start.state",
                       [&] { return kinematics.configuration(scene.srdf->state(task.state)); });
  const Eigen::Matrix3d& turned = task.basePose.linear();
  if (task.base == BaseMotion::planar) {
    q.head<2>() = task.basePose.translation().head<2>();
    q[2] = std::atan2(turned(1, 0), turned(0, 0));
  } else if (task.base == BaseMotion::floating) {
    const Eigen::AngleAxisd turn(turned);
    q.head<3>() = task.basePose.translation();
    q.segment<3>(3) = turn.angle() * turn.axis();
  }
  const std::string where = task.path + ": start.joints";
  for (const auto& [joint, value] : task.joints) {
    const std::vector<int> named = coordinatesNamed(joint, kinematics);
    if (named.empty()) refuseJoint(where, joint, kinematics);
    if (named.size() > 1) {
      std::string names;
      for (const int i : named)
        names += (names.empty() ? "" : ", ") + kinematics.names()[static_cast<std::size_t>(i)];
      throw Error(where + ": '" + joint + "' has several coordinates; give " + names);
    }
    q[named.front()] = value;
  }
  takeOffTurns(kinematics, q);
  return q;
}

std::pair<PostureTask, PostureScene> withBaseAtOrigin(PostureTask task, PostureScene scene) {
  requireBasePose(task, scene);
  task.seenFromBase = true;
  Eigen::Isometry3d stands = Eigen::Isometry3d::Identity();
  if (task.base == BaseMotion::fixed) {
    stands = task.basePose;
  } else if (task.base == BaseMotion::planar) {
    constexpr double kUpright = 1e-6;  // rad; for angles written with few digits
    const Eigen::Vector3d up = task.basePose.linear().col(2);
    if (!(up.z() > 0 && up.head<2>().norm() <= kUpright))
      throw Error(task.path +
                  ": start.base.rpy: a planar base turns about z only; leave out roll and pitch, or take the "
                  "base floating and place its root link with x, y and rz free");
    stands.translation().z() = task.basePose.translation().z();
  }
  if (stands.matrix() == Eigen::Matrix4d::Identity()) return {std::move(task), std::move(scene)};
  const Eigen::Isometry3d back = stands.inverse();
  task.basePose = back * task.basePose;
  task.toWorld = task.toWorld * stands.linear();
  for (PostureTask::Place& place : task.placements) place.placement.target = back * place.placement.target;
  for (Obstacle& obstacle : scene.obstacles) obstacle.place(back * obstacle.pose());
  if (task.base == BaseMotion::fixed) task.basePose.setIdentity();  // without rounding
  return {std::move(task), std::move(scene)};
}

}  // namespace fcl_stpbv
