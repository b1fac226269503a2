// The arms are URDF texts, composed joint by joint. Their tasks are solved with a fixed base and without
// collisions.
#include "test/posture/arms.h"

namespace fcl_stpbv::test {
namespace {

// A joint from link `links[0]` to link `links[1]`, and the child link.
std::string jointed(const std::string& name, const std::string& type, const std::array<const char*, 2>& links,
                    const std::string& origin, const std::string& axis, const std::string& limits) {
  return std::string("<link name='") + links[1] + "'/><joint name='" + name + "' type='" + type +
         "'><parent link='" + links[0] + "'/><child link='" + links[1] + "'/><origin " + origin +
         "/><axis xyz='" + axis + "'/><limit " + limits + " effort='1' velocity='1'/></joint>";
}

PostureScene sceneOf(const std::string& joints) {
  PostureScene scene;
  scene.robot = std::make_shared<const RobotModel>(
      parseUrdf("<robot name='r'><link name='base'/>" + joints + "</robot>", "r.urdf"));
  scene.geometry = std::make_shared<const RobotGeometry>();
  return scene;
}

const std::string kFirst = "lower='-2' upper='2.8'", kSecond = "lower='-2.8' upper='2.5'",
                  kThird = "lower='-2.6' upper='2.6'";

PostureTask::Place placeOf(const std::string& link, const Eigen::Isometry3d& target,
                           const std::string& name) {
  PostureTask::Place place{link, {}};
  place.placement.name = name;
  place.placement.target = target;
  return place;
}

}  // namespace

PostureScene planarArm(const std::string& mount) {
  return sceneOf(jointed("a", "revolute", {"base", "upper"}, mount, "0 1 0", kFirst) +
                 jointed("b", "revolute", {"upper", "lower"}, "xyz='0 0 0.6'", "0 1 0", kSecond) +
                 jointed("c", "revolute", {"lower", "hand"}, "xyz='0 0 0.4'", "0 1 0", kThird) +
                 jointed("end", "fixed", {"hand", "tip"}, "xyz='0 0 0.3'", "0 1 0", ""));
}

PostureScene scara() {
  const std::string limits = "lower='-2.5' upper='2.5'";
  return sceneOf(
      jointed("a", "revolute", {"base", "l1"}, "xyz='0 0 0'", "0 0 1", limits) +
      jointed("b", "revolute", {"l1", "l2"}, "xyz='0.4 0 0.1'", "0 0 1", limits) +
      jointed("c", "prismatic", {"l2", "z"}, "xyz='0.4 0 0'", "0 0 1", "lower='-0.2' upper='0.2'") +
      jointed("d", "revolute", {"z", "tool"}, "xyz='0 0 0'", "0 0 1", "lower='-3' upper='3'"));
}

PostureScene armWithFixedJoint(double angle) {
  const std::string fixed = "lower='" + std::to_string(angle) + "' upper='" + std::to_string(angle) + "'";
  return sceneOf(jointed("a", "revolute", {"base", "upper"}, "xyz='0 0 0'", "0 1 0", kFirst) +
                 jointed("b", "revolute", {"upper", "lower"}, "xyz='0 0 0.6'", "0 1 0", kSecond) +
                 jointed("out", "revolute", {"lower", "side"}, "xyz='0 0 0.1'", "1 0 0", fixed) +
                 jointed("end", "fixed", {"side", "tip"}, "xyz='0 0 0.3'", "0 1 0", ""));
}

PostureScene block() { return sceneOf(""); }

PostureScene bodiesOf(const std::string& robot, const std::string& obstacles) {
  GeometryOptions options;
  options.cacheFolder.clear();
  const auto model = [](const std::string& text, const std::string& path) {
    return std::make_shared<const RobotModel>(parseUrdf("<robot name='r'>" + text + "</robot>", path));
  };
  PostureScene scene;
  scene.robot = model(robot, "r.urdf");
  scene.geometry = std::make_shared<const RobotGeometry>(loadGeometry(*scene.robot, options));
  if (obstacles.empty()) return scene;
  const auto around = model(obstacles, "around.urdf");
  scene.obstacles = obstaclesOf(around, loadGeometry(*around, options));
  return scene;
}

std::string ball(const std::string& name, double x) {
  const std::string origin = "<origin xyz='" + std::to_string(x) + " 0 0'/>";
  return "<link name='" + name + "'><inertial>" + origin +
         "<mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial><collision>" +
         origin + "<geometry><sphere radius='0.05'/></geometry></collision></link>";
}

std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& more) {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent + "'/><child link='" +
         child + "'/>" + more + "</joint>";
}

Eigen::Isometry3d poseOf(const PostureScene& scene, const Eigen::VectorXd& q, const std::string& link) {
  const Kinematics kinematics(scene.robot, BaseMotion::fixed);
  Kinematics::State state = kinematics.makeState();
  kinematics.forward(q, state);
  return state.link[static_cast<std::size_t>(scene.robot->link(link))];
}

Eigen::VectorXd randomWithin(const PostureScene& scene, Random& random) {
  const Kinematics kinematics(scene.robot, BaseMotion::fixed);
  Eigen::VectorXd q(kinematics.size());
  for (int i = 0; i < q.size(); ++i) q[i] = random.uniform(kinematics.lower()[i], kinematics.upper()[i]);
  return q;
}

PostureTask::Place wholePose(const std::string& link, const Eigen::Isometry3d& target) {
  return placeOf(link, target, link);
}

PostureTask::Place position(const std::string& link, const Eigen::Vector3d& target, const std::string& name) {
  PostureTask::Place place =
      placeOf(link, at(target.x(), target.y(), target.z()), name.empty() ? link : name);
  place.placement.free = {false, false, false, true, true, true};
  return place;
}

Posture found(const PostureScene& scene, const std::vector<PostureTask::Place>& places,
              const PostureOptions& options) {
  PostureTask task;
  task.base = BaseMotion::fixed;
  task.placements = places;
  PostureSetup setup = setUpWithoutCollisions(task, scene);
  return findPosture(setup, options);
}

}  // namespace fcl_stpbv::test
