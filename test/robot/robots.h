// The robots that tests run on: the one in data/, and public ones beside the project where they are there.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv::test {

struct TestRobot {
  std::string name, urdf, srdf;  ///< srdf may be ""
  std::vector<std::string> packagePath;
};

/// hrp2_style, and JVRC-1 and Panda where ../shared holds them; says so where it does not.
std::vector<TestRobot> robots();

struct LoadedRobot {
  std::shared_ptr<const RobotModel> model;
  RobotGeometry geometry;
};

/// Without a cache, so that tests leave nothing behind.
LoadedRobot load(const TestRobot& robot, GeometryOptions options = {});

}  // namespace fcl_stpbv::test
