// Adds up lengths along the tree of joints. This bounds the size of the robot in every configuration, except
// for joints that slide much farther than that size. In the sum, such joints stay where they are.
#include "fcl_stpbv/robot/search_room.h"

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/bounding_ball.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kFar = 100;  // times the room: joints that slide farther are searched within the room

// Largest distance that a sliding joint moves from its origin, while the coordinate that it follows is at
// most `most` from zero.
double slideOf(const JointModel& joint, double most) {
  if (joint.type != JointType::prismatic) return 0;
  return joint.mimic ? std::abs(joint.mimic->offset) + std::abs(joint.mimic->multiplier) * most : most;
}

struct Moved {          // what one coordinate moves
  double slides = 0;    // m per unit, for the joint that slides most
  bool turns = false;   // whether any joint turns
  double most = 0;      // its largest distance from zero, as it counts for the size of the robot
  bool stands = false;  // whether it stays at rest where that size is added up
};

std::vector<Moved> movedBy(const Kinematics& kinematics) {
  std::vector<Moved> all(at(kinematics.size()));
  for (const Kinematics::Motion& motion : kinematics.motions()) {
    if (motion.joint < 0) continue;
    Moved& moved = all[at(motion.coordinate)];
    const JointType type = kinematics.robot().joints[at(motion.joint)].type;
    if (type == JointType::prismatic) moved.slides = std::max(moved.slides, std::abs(motion.multiplier));
    moved.turns |= type == JointType::revolute || type == JointType::continuous;
  }
  for (int i = 0; i < kinematics.size(); ++i) {
    all[at(i)].stands = all[at(i)].slides > 0;
    all[at(i)].most = std::abs(kinematics.neutral()[i]);
  }
  return all;
}

double finiteOrZero(double length) { return std::isfinite(length) ? length : 0; }

double reachOfBody(const Body& body) {
  const BoundingBall ball = boundingBall(body);
  return ball.centre.norm() + ball.radius;
}

// How far from the world's origin a body has to reach to meet any part of the obstacle, or of a half space or
// a plane its nearest part.
double meetingReachOf(const Obstacle& obstacle) {
  Shape shape;
  if (!shapeOf(*obstacle.geometry(), shape) || !shape.unbounded()) return finiteOrZero(reachOf(obstacle));
  const Eigen::Isometry3d& pose = obstacle.pose();
  return finiteOrZero(std::abs(shape.offset + (pose.linear() * shape.normal).dot(pose.translation())));
}

// With coordinates without limits at zero, each of two bodies is at most the largest reach from the root's
// origin. So the bodies are at most two reaches apart.
double roomOf(const Kinematics& kinematics, const RobotGeometry& geometry,
              const std::vector<Obstacle>& obstacles, const std::vector<Moved>& moved, double scale) {
  const RobotModel& robot = kinematics.robot();
  std::vector<double> most(robot.joints.size(), 0);
  for (const Kinematics::Motion& motion : kinematics.motions())
    if (motion.joint >= 0) most[at(motion.joint)] = moved[at(motion.coordinate)].most;
  double reach = 0;
  std::vector<double> way(robot.links.size(), 0);         // length from the root's origin to each link
  for (std::size_t l = 0; l < robot.links.size(); ++l) {  // parents first
    const int j = robot.links[l].parentJoint;
    if (j >= 0) {
      const JointModel& joint = robot.joints[at(j)];
      way[l] = way[at(joint.parent)] + joint.origin.translation().norm() + slideOf(joint, most[at(j)]);
    }
    const auto [first, last] = geometry.of(static_cast<int>(l));
    for (int i = first; i < last; ++i)
      reach = std::max(reach, finiteOrZero(way[l] + reachOfBody(geometry.bodies[at(i)])));
  }
  for (const Obstacle& obstacle : obstacles) reach = std::max(reach, meetingReachOf(obstacle));
  constexpr double kFarthest = 1e150;  // m: no distance is measured beyond
  return std::max(scale, std::min(2 * reach, kFarthest));
}

double scaleOf(const RobotGeometry& geometry) {
  constexpr double kSmall = 0.1, kLarge = 1;  // m: usual radii of the largest body
  double largest = 0;
  for (const Body& body : geometry.bodies)
    largest = std::max(largest, finiteOrZero(boundingBall(body).radius));
  if (largest > kLarge) return largest / kLarge;
  return largest > 0 ? std::min(1.0, largest / kSmall) : 1;
}

}  // namespace

double reachOf(const RobotGeometry& geometry, int link) {
  double reach = 0;
  const auto [first, last] = geometry.of(link);
  for (int i = first; i < last; ++i) reach = std::max(reach, reachOfBody(geometry.bodies[at(i)]));
  return reach;
}

double reachOf(const Obstacle& obstacle) { return obstacle.centre().norm() + obstacle.radius(); }

double lengthOf(const RobotModel& robot, int joint) {
  const JointModel& model = robot.joints[at(joint)];
  const JointModel& leader = model.mimic ? robot.joints[at(model.mimic->joint)] : model;
  return model.origin.translation().norm() +
         slideOf(model, std::max(std::abs(leader.lower), std::abs(leader.upper)));
}

SearchRoom searchRoom(const Kinematics& kinematics, const RobotGeometry& geometry,
                      const std::vector<Obstacle>& obstacles) {
  const VectorXd &lower = kinematics.lower(), &upper = kinematics.upper();
  SearchRoom found{lower, upper, VectorXd::Ones(lower.size()), scaleOf(geometry), {}, 0};
  std::vector<Moved> moved = movedBy(kinematics);
  double room = roomOf(kinematics, geometry, obstacles, moved, found.scale);
  for (bool grows = true; grows;) {  // with each joint that is short for the room, which may be others then
    grows = false;
    for (Index i = 0; i < lower.size(); ++i) {
      Moved& m = moved[static_cast<std::size_t>(i)];
      if (!m.stands || m.slides * (upper[i] - lower[i]) > kFar * room) continue;
      m.stands = false;
      m.most = std::max(std::abs(lower[i]), std::abs(upper[i]));
      grows = true;
    }
    if (grows) room = roomOf(kinematics, geometry, obstacles, moved, found.scale);
  }
  for (Index i = 0; i < lower.size(); ++i) {
    constexpr double kSteps = 200;  // steps of a descent, which together cover the whole range
    const Moved& m = moved[static_cast<std::size_t>(i)];
    if (!std::isfinite(lower[i])) found.lower[i] = -room;
    if (!std::isfinite(upper[i])) found.upper[i] = found.unit[i] = room;
    if (m.slides > 0 && !m.turns) found.unit[i] = std::max(found.scale, (upper[i] - lower[i]) / kSteps);
    if (!m.stands) continue;
    const double half = m.turns ? std::max(kPi, room / m.slides) : room / m.slides;
    if (!m.turns) found.unit[i] = half;
    found.lower[i] = std::max(lower[i], kinematics.neutral()[i] - half);
    found.upper[i] = std::min(upper[i], kinematics.neutral()[i] + half);
    found.narrowed.push_back(i);
    found.doublings = std::max(found.doublings, std::ilogb((upper[i] - lower[i]) / half));
  }
  return found;
}

VectorXd randomConfiguration(const Kinematics& kinematics, const SearchRoom& room, std::mt19937_64& random) {
  VectorXd lower = room.lower, upper = room.upper, q(kinematics.size());
  if (!room.narrowed.empty() && random() % 4 == 0) {
    const double factor =
        std::ldexp(1.0, 1 + static_cast<int>(random() % static_cast<unsigned>(room.doublings + 1)));
    for (Index i : room.narrowed) {
      const double middle = kinematics.neutral()[i];
      lower[i] = std::max(kinematics.lower()[i], middle + factor * (lower[i] - middle));
      upper[i] = std::min(kinematics.upper()[i], middle + factor * (upper[i] - middle));
    }
  }
  // The distributions of the standard library are not used, because they differ between implementations.
  for (Index i = 0; i < q.size(); ++i)
    q[i] = lower[i] + static_cast<double>(random() >> 11) * 0x1p-53 * (upper[i] - lower[i]);
  return q;
}

}  // namespace fcl_stpbv::detail
