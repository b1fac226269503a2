// See robots.h.
#include "test/robot/robots.h"

#include <catch2/catch.hpp>

#include "test/volume/volume_files.h"

namespace fcl_stpbv::test {

std::vector<TestRobot> robots() {
  const std::string data = FCL_STPBV_SOURCE_DIR "/data/hrp2_style/hrp2_style";
  std::vector<TestRobot> list{{"hrp2_style", data + ".urdf", data + ".srdf", {}}};
  const std::string shared = sharedFolder("robots");
  if (shared.empty()) {
    WARN("JVRC-1 and Panda skipped: no ../shared/robots");
    return list;
  }
  list.push_back({"JVRC-1", shared + "/jvrc_description/urdf/jvrc1.urdf", "", {shared}});
  list.push_back({"Panda",
                  shared + "/panda_description/urdf/panda.urdf",
                  shared + "/panda_description/srdf/panda.srdf",
                  {shared}});
  return list;
}

LoadedRobot load(const TestRobot& robot, GeometryOptions options) {
  options.packagePath = robot.packagePath;
  options.cacheFolder.clear();
  auto model = std::make_shared<const RobotModel>(loadUrdf(robot.urdf));
  RobotGeometry geometry = loadGeometry(*model, options);
  return {model, std::move(geometry)};
}

}  // namespace fcl_stpbv::test
