// Uses the robot component from an installed tree: reads a URDF. The members of a robot lie in memory as in
// the library, so this links only with flags for which Eigen's types have the same layout.
#include <fcl_stpbv/robot/kinematics.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto robot = std::make_shared<const fcl_stpbv::RobotModel>(fcl_stpbv::loadUrdf(argv[1]));
  const Eigen::VectorXd neutral = fcl_stpbv::Kinematics(robot).neutral();
  std::printf("%zu links, %ld coordinates\n", robot->links.size(), static_cast<long>(neutral.size()));
  return robot->joints.size() + 1 == robot->links.size() && neutral.size() > 0 ? 0 : 1;
}
