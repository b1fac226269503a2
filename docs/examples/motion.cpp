// The code of docs/motion.md, for the robot in data/hrp2_style. Run it in that folder.
#include <cstdio>

#include "docs/examples/named.h"
#include "docs/examples/reported.h"
#include "fcl_stpbv/robot/motion_check.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;

namespace {

int run() {
  const auto robot = std::make_shared<const RobotModel>(loadUrdf("hrp2_style.urdf"));
  const auto geometry = std::make_shared<const RobotGeometry>(loadGeometry(*robot));
  const auto kinematics = std::make_shared<const Kinematics>(robot);
  const Eigen::VectorXd q0 = kinematics->neutral();
  Eigen::VectorXd q1 = q0;
  q1[coordinateOf(*kinematics, "RARM_JOINT1")] -= 0.3;
  // clang-format off
MotionCheck check(kinematics, geometry, selfPairs(*robot, *geometry, nullptr));
const bool free = check.isMotionFree(q0, q1, 0.01);             // nowhere a pair within 1 cm
const MotionBracket first = check.firstContact(q0, q1);         // first.verdict, .from, .until, .pair
  // clang-format on
  std::printf("%s; free until %g\n", free ? "free" : "not free", first.from);
  return first.from >= 0 && first.from <= 1 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) { return reported(argc, argv, run); }
