// See scene.h.
#include "scene.h"

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/posture/find_posture.h"
#include "fcl_stpbv/posture/task.h"

namespace example {

using namespace fcl_stpbv;

Eigen::VectorXd Scene::whole(const double* planned) const {
  Eigen::VectorXd q = goal;
  for (std::size_t i = 0; i < coordinates.size(); ++i) q[coordinates[i]] = planned[i];
  return q;
}

namespace {

/// The pairs without those that the planned coordinates do not move, which are always or never clear.
std::vector<CheckedPair> movedPairs(const Scene& scene, const std::vector<CheckedPair>& pairs) {
  Eigen::VectorXd moved = scene.start;
  for (const int k : scene.coordinates) moved[k] += 0.1 + 0.01 * k;
  Kinematics::State before = scene.kinematics->makeState(), after = scene.kinematics->makeState();
  scene.kinematics->forward(scene.start, before);
  scene.kinematics->forward(moved, after);
  const auto moves = [&](int body) {
    const auto link = static_cast<std::size_t>(scene.smooth->bodies[static_cast<std::size_t>(body)].link);
    return before.link[link].matrix() != after.link[link].matrix();
  };
  std::vector<CheckedPair> kept;
  for (const CheckedPair& pair : pairs)
    if (moves(pair.body) || (!pair.obstacle && moves(pair.other))) kept.push_back(pair);
  return kept;
}

}  // namespace

Scene loadScene(const std::string& data) {
  const std::string folder = data + "/hrp2_style/hrp2_style", fridge = data + "/fridge/";
  const auto robot = std::make_shared<const RobotModel>(loadUrdf(folder + ".urdf"));
  const auto around = std::make_shared<const RobotModel>(loadUrdf(fridge + "fridge.urdf"));
  const auto srdf = std::make_shared<const Srdf>(loadSrdf(folder + ".srdf", *robot));
  Scene scene;
  GeometryOptions options;
  options.radii = {0.01, 10};
  scene.smooth = std::make_shared<const RobotGeometry>(loadGeometry(*robot, options));
  scene.obstacles = obstaclesOf(around, loadGeometry(*around, options));
  options.flat = true;
  scene.hulls = std::make_shared<const RobotGeometry>(loadGeometry(*robot, options));
  scene.hullObstacles = obstaclesOf(around, loadGeometry(*around, options));

  const PostureTask task = loadTask(fridge + "pick_can.json");
  const PostureScene posed{robot, scene.smooth, srdf, scene.obstacles};
  PostureSetup setup = setUp(task, posed);
  const Posture posture = findPosture(setup);
  if (!posture.feasible) throw Error("pick_can.json: no posture was found");
  scene.kinematics = std::make_shared<const Kinematics>(robot, task.base);
  scene.goal = scene.start = posture.q;
  const Eigen::VectorXd standing = startOf(task, posed, *scene.kinematics);
  for (int k = 0; k < scene.kinematics->size(); ++k) {
    const std::string& name = scene.kinematics->names()[static_cast<std::size_t>(k)];
    if (name.find("ARM_") == std::string::npos && name.find("CHEST") == std::string::npos &&
        name.find("HEAD") == std::string::npos)
      continue;
    scene.coordinates.push_back(k);
    scene.start[k] = standing[k];
  }
  scene.pairs = movedPairs(scene, setup.pairs);
  return scene;
}

}  // namespace example
