// Loads the robot of data/hrp2_style, and the fridge and the task of data/fridge. Volumes are built once per
// program, without a cache.
#include "test/posture/scenes.h"

#include "test/reference/source_folder.h"

namespace fcl_stpbv::test {
namespace {

const std::string kData = test::sourceFolder() + "/data/";

}  // namespace

std::shared_ptr<const RobotModel> fridgeModel() {
  return std::make_shared<const RobotModel>(loadUrdf(kData + "fridge/fridge.urdf"));
}

PostureScene hrp2Scene(bool fridge) {
  static const PostureScene scene = [] {  // its volumes take a second
    GeometryOptions options;
    options.cacheFolder.clear();
    PostureScene made;
    made.robot = std::make_shared<const RobotModel>(loadUrdf(kData + "hrp2_style/hrp2_style.urdf"));
    made.srdf = std::make_shared<const Srdf>(loadSrdf(kData + "hrp2_style/hrp2_style.srdf", *made.robot));
    made.geometry = std::make_shared<const RobotGeometry>(loadGeometry(*made.robot, options));
    const auto model = fridgeModel();
    made.obstacles = obstaclesOf(model, loadGeometry(*model, options));
    return made;
  }();
  PostureScene copy = scene;
  if (!fridge) copy.obstacles.clear();
  return copy;
}

PostureTask pickCan() { return loadTask(kData + "fridge/pick_can.json"); }

}  // namespace fcl_stpbv::test
