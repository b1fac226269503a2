// Finds the joints between two links: the chains of both links up to the root, without their common part.
#include "fcl_stpbv/robot/joint_path.h"

namespace fcl_stpbv::detail {
namespace {

std::vector<int> jointsAbove(const RobotModel& robot, int link) {
  const auto above = [&](int l) { return robot.links[static_cast<std::size_t>(l)].parentJoint; };
  std::vector<int> joints;
  for (int j = above(link); j >= 0; j = above(robot.joints[static_cast<std::size_t>(j)].parent))
    joints.push_back(j);
  return joints;
}

}  // namespace

JointPath jointPath(const RobotModel& robot, int link1, int link2) {
  std::vector<int> up1 = jointsAbove(robot, link1), up2 = jointsAbove(robot, link2);
  while (!up1.empty() && !up2.empty() && up1.back() == up2.back()) {
    up1.pop_back();
    up2.pop_back();
  }
  JointPath path;
  path.up = up1.size();
  path.joints = std::move(up1);
  path.joints.insert(path.joints.end(), up2.rbegin(), up2.rend());
  return path;
}

}  // namespace fcl_stpbv::detail
