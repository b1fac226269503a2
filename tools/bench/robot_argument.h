// The robot on a benchmark's command line.
#pragma once

#include "test/reference/robots.h"
#include "tools/program.h"

namespace fcl_stpbv::benchmark {

/// Adds ROBOT, --srdf and --package-path to the options.
inline void describeRobot(tools::Program& program, test::TestRobot& robot) {
  program.option("ROBOT", robot.urdf, "the robot's URDF").required();
  program.option("--srdf", robot.srdf, "whose pairs are left out; else adjacent ones are");
  program.option("--package-path", robot.packagePath, "folder that holds packages").repeated();
}

}  // namespace fcl_stpbv::benchmark
