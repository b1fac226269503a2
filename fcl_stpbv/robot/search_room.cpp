// Adds up lengths along the tree of joints. This bounds the size of the robot in every configuration.
#include "fcl_stpbv/robot/search_room.h"

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

double reachOf(const RobotGeometry& geometry, int link) {
  double reach = 0;
  const auto [first, last] = geometry.of(link);
  for (int i = first; i < last; ++i)
    reach = std::max(reach, geometry.bodies[at(i)].centre.norm() + geometry.bodies[at(i)].radius);
  return reach;
}

double lengthOf(const RobotModel& robot, int joint) {
  const JointModel& model = robot.joints[at(joint)];
  double slide =
      model.type == JointType::prismatic ? std::max(std::abs(model.lower), std::abs(model.upper)) : 0;
  if (model.mimic && model.type == JointType::prismatic) {
    const JointModel& leader = robot.joints[at(model.mimic->joint)];
    slide = std::abs(model.mimic->offset) +
            std::abs(model.mimic->multiplier) * std::max(std::abs(leader.lower), std::abs(leader.upper));
  }
  return model.origin.translation().norm() + slide;
}

// Each of two bodies is at most the largest reach from the root's origin while what has no limits is at zero,
// so they are at most two reaches apart.
double searchRoom(const RobotModel& robot, const RobotGeometry& geometry,
                  const std::vector<Obstacle>& obstacles) {
  double reach = 0;
  std::vector<double> way(robot.links.size(), 0);         // from the root's origin
  for (std::size_t l = 0; l < robot.links.size(); ++l) {  // parents first
    const int joint = robot.links[l].parentJoint;
    if (joint >= 0) way[l] = way[at(robot.joints[at(joint)].parent)] + lengthOf(robot, joint);
    const auto [first, last] = geometry.of(static_cast<int>(l));
    if (first < last) reach = std::max(reach, way[l] + reachOf(geometry, static_cast<int>(l)));
  }
  for (const Obstacle& obstacle : obstacles)
    reach = std::max(reach, obstacle.centre.norm() + obstacle.radius);
  return std::max(1.0, 2 * reach);
}

}  // namespace fcl_stpbv::detail
