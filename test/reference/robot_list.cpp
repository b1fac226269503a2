// Finds the robots' files, and warns about missing ones. Uses Catch2, which only the tests link.
#include <catch2/catch.hpp>

#include "test/reference/robots.h"
#include "test/reference/source_folder.h"
#include "test/reference/volume_files.h"

namespace fcl_stpbv::test {

std::vector<TestRobot> robots() {
  const std::string data = sourceFolder() + "/data/hrp2_style/hrp2_style";
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

}  // namespace fcl_stpbv::test
