// Uses the robot component from an installed tree: reads a URDF. What a program has of a robot lies where the
// library puts it, so this links only with flags under which Eigen does the same.
#include <fcl_stpbv/robot/kinematics.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto robot = std::make_shared<const fcl_stpbv::RobotModel>(fcl_stpbv::loadUrdf(argv[1]));
  const Eigen::VectorXd neutral = fcl_stpbv::Kinematics(robot).neutral();
  std::printf("%zu links, %ld coordinates\n", robot->links.size(), static_cast<long>(neutral.size()));
  return robot->joints.size() + 1 == robot->links.size() && neutral.size() > 0 ? 0 : 1;
}
