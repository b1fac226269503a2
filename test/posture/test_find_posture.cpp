// Whole postures: the fridge, tasks that cannot be solved, starts that fail.
#include <catch2/catch.hpp>

#include "fcl_stpbv/posture/find_posture.h"
#include "fcl_stpbv/robot/constraints.h"
#include "fcl_stpbv/robot/pair_list.h"
#include "test/posture/scenes.h"
#include "test/reference/mesh_check.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

namespace {

// The pairs of the hand that holds the can.
const std::vector<std::pair<std::string, std::string>> kHeld{{"LARM_LINK5", "can"}, {"LARM_LINK6", "can"}};

Eigen::Isometry3d placed(const Kinematics& kinematics, const Eigen::VectorXd& q,
                         const PostureTask::Place& place) {
  Kinematics::State state = kinematics.makeState();
  kinematics.forward(q, state);
  const int link = kinematics.robot().link(place.link);
  return place.placement.target.inverse() * state.link[static_cast<std::size_t>(link)] *
         place.placement.frame;
}

}  // namespace

TEST_CASE("the can is taken from the fridge without a collision of the original meshes") {
  const PostureScene scene = hrp2Scene();
  const PostureTask task = pickCan();
  PostureSetup setup = setUp(task, scene);
  const Posture posture = findPosture(setup);
  REQUIRE(posture.feasible);
  CHECK(posture.violations.empty());
  CHECK(posture.starts == 1);
  CHECK(std::count_if(setup.pairs.begin(), setup.pairs.end(),
                      [](const CheckedPair& p) { return p.obstacle; }) == 33);
  CHECK(posture.distanceCalls > 100);
  // Fewer than the paper's FSQP took on HRP-2, 74: the table of docs/posture.md, "Pick-can-from-fridge".
  CHECK(posture.iterations < 74);

  const Kinematics& kinematics = setup.problem->kinematics();
  ConstraintOptions asked;
  asked.obstacles = scene.obstacles;
  CollisionConstraints distances(std::make_shared<const Kinematics>(kinematics), scene.geometry, setup.pairs,
                                 asked);
  Eigen::VectorXd d(distances.rows());
  distances.evaluate(posture.q, d);
  CHECK(d.minCoeff() >= 0);  // not only within a tolerance
  for (const PostureTask::Place& place : task.placements) {
    const Eigen::Isometry3d miss = placed(kinematics, posture.q, place);
    CHECK(miss.translation().norm() < 1e-4);
    const Eigen::Vector3d axis = miss.linear().col(2);  // axis about which the hand may turn
    CHECK((place.placement.free[5] ? (axis - Eigen::Vector3d::UnitZ()).norm()
                                   : (miss.linear() - Eigen::Matrix3d::Identity()).norm()) < 1e-4);
  }
  for (int i = 6; i < kinematics.size(); ++i) {
    CHECK(posture.q[i] >= kinematics.lower()[i] - 1e-6);
    CHECK(posture.q[i] <= kinematics.upper()[i] + 1e-6);
  }
  // The feet stand straight: the support polygon is the hull of the soles' rectangles.
  Kinematics::State state = kinematics.makeState();
  kinematics.forward(posture.q, state);
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < scene.robot->links.size(); ++i) {
    mass += scene.robot->links[i].mass;
    centre += scene.robot->links[i].mass * (state.link[i] * scene.robot->links[i].centreOfMass);
  }
  centre /= mass;
  CHECK(centre.x() >= -0.1 + 0.02 - 1e-5);
  CHECK(centre.x() <= 0.14 - 0.02 + 1e-5);
  CHECK(std::abs(centre.y()) <= 0.095 + 0.07 - 0.02 + 1e-5);

  MeshCheck check(scene.robot, fridgeModel(), {}, kHeld);
  const auto links = linksOf(setup.pairs, *scene.geometry);
  CHECK(check.collisions(kinematics, posture.q, links) == std::vector<std::string>{});

  // Without the collision constraints, the posture runs into the fridge. Otherwise the task would test
  // nothing.
  PostureSetup free = setUpWithoutCollisions(task, scene);
  const Posture careless = findPosture(free);
  REQUIRE(careless.feasible);
  CHECK(careless.cost < posture.cost);
  CHECK(check.collisions(kinematics, careless.q, links).size() >= 3);
}

TEST_CASE("the same seed gives the same posture to the bit") {
  const PostureScene scene = hrp2Scene();
  const auto run = [&] {
    PostureSetup setup = setUp(pickCan(), scene);
    return findPosture(setup);
  };
  const Posture first = run(), second = run();
  CHECK(first.q == second.q);
  CHECK(first.iterations == second.iterations);
}

TEST_CASE("a robot that faces anywhere takes the can as well") {
  // The whole scene turned about z. The base's rotation vectors go up to half a turn and beyond.
  for (const double yaw : {1.5, 3.0, M_PI, -2.5}) {
    const Eigen::Isometry3d turn(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
    PostureScene scene = hrp2Scene();
    PostureTask task = pickCan();
    task.basePose = turn * task.basePose;
    for (PostureTask::Place& place : task.placements) place.placement.target = turn * place.placement.target;
    for (Obstacle& obstacle : scene.obstacles) obstacle.place(turn * obstacle.pose());
    PostureSetup setup = setUp(task, scene);
    const Posture posture = findPosture(setup);
    INFO("yaw " << yaw);
    CHECK(posture.feasible);
    CHECK(posture.cost == Approx(0.642).margin(0.01));  // the same local answer
  }
}

TEST_CASE("a task that cannot be solved names the constraints that contradict each other") {
  PostureScene scene = hrp2Scene(false);
  PostureTask task = pickCan();
  task.pairs.clear();
  task.placements[2].placement.target.translation() = Eigen::Vector3d(1.6, 0.1, 1.0);  // a metre too far away
  PostureSetup setup = setUp(task, scene);
  PostureOptions options;
  options.starts = 2;
  const Posture posture = findPosture(setup, options);
  CHECK_FALSE(posture.feasible);
  CHECK(posture.starts == 2);
  REQUIRE_FALSE(posture.violations.empty());
  CHECK(posture.q.allFinite());
  CHECK(posture.status == "stuck");
  const auto named = [&](const std::string& word) {
    return std::any_of(posture.conflict.begin(), posture.conflict.end(),
                       [&](const Violation& v) { return v.name.find(word) != std::string::npos; });
  };
  CHECK(named("left hand x"));
  CHECK((named("foot") || named("stability")));
}

TEST_CASE("an obstacle in the way of the hand is named") {
  PostureScene scene = hrp2Scene();
  PostureTask task = pickCan();
  task.placements[2].placement.target.translation() =
      Eigen::Vector3d(0.5, 0.235, 0.96);  // within the left panel
  PostureSetup setup = setUp(task, scene);
  PostureOptions options;
  options.starts = 2;
  const Posture posture = findPosture(setup, options);
  CHECK_FALSE(posture.feasible);
  CHECK(std::any_of(posture.conflict.begin(), posture.conflict.end(),
                    [](const Violation& v) { return v.name.find("left_panel") != std::string::npos; }));
}

TEST_CASE("JVRC-1 reaches for something with nothing about it in the code") {
  const std::vector<TestRobot> all = robots();
  const auto jvrc =
      std::find_if(all.begin(), all.end(), [](const TestRobot& r) { return r.name == "JVRC-1"; });
  if (jvrc == all.end()) return;  // robots() has reported this
  const LoadedRobot loaded = load(*jvrc);
  PostureScene scene{loaded.model, std::make_shared<const RobotGeometry>(loaded.geometry), nullptr, {}};
  // The robot has no SRDF, so the pairs come from the pair list.
  PairListOptions search;
  search.samples = 200;
  auto srdf = std::make_shared<Srdf>();
  srdf->disabled =
      toSrdf(*loaded.model,
             pairList(std::make_shared<const Kinematics>(loaded.model), scene.geometry, nullptr, search),
             true);  // the hulls of pelvis and hips meet in the neutral posture
  scene.srdf = srdf;
  const PostureTask task = parseTask(R"({
    "start": {"base": {"position": [0, 0, 0.85]}},
    "placements": [
      {"name": "right foot", "link": "R_ANKLE_P_S", "target": {"position": [0, -0.1, 0.1]}},
      {"name": "left foot", "link": "L_ANKLE_P_S", "target": {"position": [0, 0.1, 0.1]}},
      {"name": "left hand", "link": "L_WRIST_Y_S", "target": {"position": [0.4, 0.3, 1.0]}, "free": ["rx", "ry", "rz"]}],
    "stability": {"margin": 0.01, "contacts": [
      {"link": "R_ANKLE_P_S", "points": [[0.1, 0.04, -0.1], [0.1, -0.04, -0.1], [-0.08, 0.04, -0.1], [-0.08, -0.04, -0.1]]},
      {"link": "L_ANKLE_P_S", "points": [[0.1, 0.04, -0.1], [0.1, -0.04, -0.1], [-0.08, 0.04, -0.1], [-0.08, -0.04, -0.1]]}]}})",
                                     "jvrc reach");
  PostureSetup setup = setUp(task, scene);
  const Posture posture = findPosture(setup);
  for (const Violation& v : posture.violations) UNSCOPED_INFO(v.name << " " << v.amount);
  for (const Violation& v : posture.conflict) UNSCOPED_INFO("conflict " << v.name << " " << v.amount);
  REQUIRE(posture.feasible);
  CHECK(setup.pairs.size() > 100);
  CHECK(placed(setup.problem->kinematics(), posture.q, task.placements[2]).translation().norm() < 1e-4);
  MeshCheck check(scene.robot, nullptr, jvrc->packagePath);
  CHECK(check.collisions(setup.problem->kinematics(), posture.q, linksOf(setup.pairs, *scene.geometry)) ==
        std::vector<std::string>{});
}
