// The start of the base and the joints in a task: a fixed base stands there, a planar one keeps its height,
// every coordinate has its name. Also starts that fail.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/error.h"
#include "test/posture/arms.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

namespace {

const std::string kHinge =
    "<origin xyz='0 0 0.2'/><axis xyz='0 0 1'/><limit lower='-2' upper='2' effort='1' velocity='1'/>";

// A ball at the end of an arm of 50 cm, 20 cm above its base, and a ball that is an obstacle.
PostureScene armAmong(const std::string& obstacle) {
  return bodiesOf(ball("base") + ball("arm", 0.5) + joint("j", "revolute", "base", "arm", kHinge),
                  "<link name='world'/>" + ball("post") +
                      joint("at", "fixed", "world", "post", "<origin xyz='" + obstacle + "'/>"));
}

PostureTask taskOf(const std::string& text) { return parseTask(text, "task.json"); }

Posture solved(const std::string& task, const PostureScene& scene) {
  PostureSetup setup = setUp(taskOf(task), scene);
  return findPosture(setup);
}

std::string refusalOf(const std::string& task, const PostureScene& scene) {
  try {
    setUp(taskOf(task), scene);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

// A task for the arm's end, with the base at (5, 0, 1) turned by a quarter about z: the end is at (5, 0.5,
// 1.2) for j = 0.
std::string standing(const std::string& base, const std::string& target) {
  return R"({"base": ")" + base +
         R"(", "start": {"base": {"position": [5, 0, 1], "rpy": [0, 0, 1.5707963267948966]}},
             "cost": {"towards": "start"}, "placements": [{"link": "arm", "frame": {"position": [0.5, 0, 0]},
             "target": {"position": )" +
         target + R"(}, "free": ["rx", "ry", "rz"]}]})";
}

const std::string kCart = ball("base") + ball("cart") + ball("hand", 0.3) +
                          joint("p", "planar", "base", "cart", "<origin xyz='0 0 0.3'/><axis xyz='0 0 1'/>") +
                          joint("j", "revolute", "cart", "hand", kHinge);

}  // namespace

TEST_CASE("a fixed base stands where the task puts it") {
  const PostureScene scene = armAmong("0 9 0");
  const Posture posture = solved(standing("fixed", "[5, 0.5, 1.2]"), scene);
  REQUIRE(posture.feasible);
  CHECK(std::abs(posture.q[0]) < 1e-5);
  CHECK_FALSE(solved(standing("fixed", "[0, 0.5, 1.2]"), scene).feasible);
  CHECK_FALSE(solved(standing("fixed", "[0.5, 0, 0.2]"), scene).feasible);
  // The obstacle is in the world, and it blocks the way there.
  const Posture blocked = solved(standing("fixed", "[5, 0.5, 1.2]"), armAmong("5 0.55 1.2"));
  CHECK_FALSE(blocked.feasible);
  REQUIRE_FALSE(blocked.conflict.empty());
  CHECK(blocked.conflict.front().name == "arm - post");
}

TEST_CASE("a fixed base that is tilted tilts the ground that the robot stands on") {
  const PostureScene scene = armAmong("0 9 0");
  const auto task = [](const std::string& rpy) {
    return R"({"base": "fixed", "start": {"base": {"position": [0, 0, 3], "rpy": )" + rpy +
           R"(}}, "placements": [], "stability": {"contacts": [{"link": "base", "points":
               [[0.3, 0.3, 0], [0.3, -0.3, 0], [-0.3, -0.3, 0], [-0.3, 0.3, 0]]}]}})";
  };
  CHECK(solved(task("[0, 0, 0]"), scene).feasible);
  CHECK(solved(task("[0, 0, 2]"), scene).feasible);
  CHECK_FALSE(solved(task("[0, 1.5707963267948966, 0]"), scene).feasible);  // an edge on the ground
}

TEST_CASE("a planar base keeps the height that the task gives it, and cannot be tilted") {
  const PostureScene scene = armAmong("0 9 0");
  const Posture posture = solved(standing("planar", "[5.2, 0.6, 1.2]"), scene);
  REQUIRE(posture.feasible);
  const Kinematics kinematics(scene.robot, BaseMotion::planar);
  Kinematics::State state = kinematics.makeState();
  kinematics.forward(posture.q, state);
  const Eigen::Vector3d end = state.link[1] * Eigen::Vector3d(0.5, 0, 0);
  CHECK((end - Eigen::Vector3d(5.2, 0.6, 0.2)).norm() < 1e-5);  // x and y are those of the world
  CHECK_FALSE(solved(standing("planar", "[5.2, 0.6, 0.2]"), scene).feasible);
  const std::string tilted =
      refusalOf(R"({"base": "planar", "start": {"base": {"rpy": [0.1, 0, 0]}}, "placements": []})", scene);
  CHECK(tilted.find("task.json: start.base.rpy: a planar base turns about z only") == 0);
}

TEST_CASE("a planar base turns to any direction, from any start") {
  const PostureScene scene = armAmong("0 9 0");
  for (const double start : {0.0, 2.0, -3.0})
    for (const double turn : {0.5, 1.6, -2.0, 2.5, 3.0, -3.1}) {
      const std::string to = std::to_string(start + turn);
      const Posture posture = solved(
          R"({"base": "planar", "start": {"base": {"rpy": [0, 0, )" + std::to_string(start) +
              R"(]}}, "placements": [{"link": "base", "target": {"position": [-1, 0, 0], "rpy": [0, 0, )" +
              to + R"(]}}]})",
          scene);
      CAPTURE(start, turn, posture.q.transpose());
      REQUIRE(posture.feasible);
      CHECK(std::abs(std::remainder(posture.q[2] - start - turn, 2 * M_PI)) < 1e-5);  // six decimals, 1e-6
    }
}

TEST_CASE("the weight of a joint is not that of another whose name begins with its own") {
  const PostureScene scene =
      bodiesOf(kCart + ball("tool") + joint("p/tool", "revolute", "cart", "tool", kHinge));
  const PostureTask task = taskOf(R"({"base": "fixed", "cost": {"weights": {"p": 7}}, "placements": []})");
  PostureSetup setup = setUpWithoutCollisions(task, scene);
  CHECK(setup.problem->costCurvature() / 2 == (Eigen::VectorXd(5) << 7, 7, 7, 1, 1).finished());
}

TEST_CASE("every coordinate has the name that answers have") {
  const PostureScene scene = bodiesOf(kCart);
  const PostureTask task = taskOf(R"({"base": "floating", "start": {"base": {"position": [1, 2, 3]},
      "joints": {"p/x": 0.1, "p/y": 0.2, "p/angle": 0.3, "j": 0.4, "base/y": 7}},
      "cost": {"weights": {"p": 4, "p/y": 5, "base/z": 6}}, "placements": []})");
  const Kinematics kinematics(scene.robot, task.base);
  const Eigen::VectorXd q = startOf(task, scene, kinematics);
  CHECK(q.head<3>() == Eigen::Vector3d(1, 7, 3));
  CHECK(q.tail<4>() == Eigen::Vector4d(0.1, 0.2, 0.3, 0.4));
  PostureSetup setup = setUpWithoutCollisions(task, scene);
  const Eigen::VectorXd weights = setup.problem->costCurvature() / 2;
  CHECK(weights.tail<5>() == (Eigen::VectorXd(5) << 0, 4, 5, 4, 1).finished());
  CHECK(weights[2] == 6);
  const auto refused = [&](const std::string& joints) {
    return refusalOf(R"({"base": "fixed", "placements": [], "start": {"joints": )" + joints + "}}", scene);
  };
  CHECK(refused(R"({"p": 1})").find("start.joints: 'p' has several coordinates; give p/x, p/y, p/angle") !=
        std::string::npos);
  CHECK(refused(R"({"base/x": 1})").find("no joint 'base/x'") != std::string::npos);
}

TEST_CASE("full turns of a start make no difference, but for a joint that others follow at another speed") {
  const std::string hand = ball("base") + ball("cart") + ball("hand", 0.3) + ball("tool") + ball("rack") +
                           joint("p", "planar", "base", "cart", "<axis xyz='0 0 1'/>") +
                           joint("c", "continuous", "cart", "hand", "") +
                           joint("l", "continuous", "hand", "tool", "") +
                           joint("m", "revolute", "tool", "rack",
                                 "<limit lower='-9' upper='9' effort='1' velocity='1'/>"
                                 "<mimic joint='l' multiplier='0.5'/>");
  const PostureScene scene = bodiesOf(hand);
  const auto startWith = [&](const std::string& base, const std::string& joints) {
    const PostureTask task =
        taskOf(R"({"base": ")" + base + R"(", "placements": [], "start": {"joints": )" + joints + "}}");
    return startOf(task, scene, Kinematics(scene.robot, task.base));
  };
  const auto isNear = [](double found, double expected) { return std::abs(found - expected) < 1e-12; };
  const Eigen::VectorXd q = startWith("planar", R"({"c": 4, "p/angle": -50, "base/angle": 7, "l": 4})");
  const Kinematics kinematics(scene.robot, BaseMotion::planar);
  const auto of = [&](const std::string& name) {
    const auto& names = kinematics.names();
    return q[std::find(names.begin(), names.end(), name) - names.begin()];
  };
  CHECK(isNear(of("c"), 4 - 2 * M_PI));
  CHECK(isNear(of("p/angle"), -50 + 16 * M_PI));
  CHECK(isNear(of("base/angle"), 7 - 2 * M_PI));
  CHECK(of("l") == 4);  // half a turn less would be another posture for `m`
  const Eigen::VectorXd turned = startWith("floating", R"({"base/rx": 5, "base/rz": -1})");
  const Eigen::Vector3d given(5, 0, -1);
  const auto rotation = [](const Eigen::Vector3d& v) {
    return Eigen::AngleAxisd(v.norm(), v.normalized()).toRotationMatrix();
  };
  CHECK(turned.segment<3>(3).norm() < M_PI);
  CHECK((rotation(turned.segment<3>(3)) - rotation(given)).norm() < 1e-14);
  CHECK(startWith("floating", R"({"base/rx": 3, "c": -3})").segment<3>(3) == Eigen::Vector3d(3, 0, 0));
}

TEST_CASE("a start of another size than the robot's is refused") {
  const PostureScene scene = armAmong("0 0 3");
  const std::string reach = R"("placements": [{"link": "arm", "target": {"position": [0.5, 0, 0.2]}}])";
  const Posture fixed = solved(R"({"base": "fixed", )" + reach + "}", scene);
  PostureSetup setup = setUp(taskOf(R"({"base": "planar", )" + reach + "}"), scene);
  setup.start = fixed.q;
  CHECK_THROWS_WITH(findPosture(setup), Catch::Contains("start has 1 coordinates, the robot 4"));
  setup.start.setZero(40);
  CHECK_THROWS_WITH(findPosture(setup), Catch::Contains("start has 40 coordinates"));
}

TEST_CASE("random starts of a joint whose limits stand for none are where bodies can meet") {
  // What a carriage on a rail is drawn at is what it ends at, as nothing asks for another place.
  const PostureScene scene = bodiesOf(ball("base") + ball("cart") +
                                      joint("rail", "prismatic", "base", "cart",
                                            "<origin xyz='0 1 0'/><axis xyz='1 0 0'/><limit lower='-1e16' "
                                            "upper='1e16' effort='1' velocity='1'/>"));
  for (const double start : {0.0, 3000.0}) {
    PostureSetup setup = setUp(taskOf(R"({"base": "fixed", "placements": [], "start": {"joints": {"rail": )" +
                                      std::to_string(start) + R"(}}, "cost": {"weights": {"rail": 0}}})"),
                               scene);
    PostureOptions options;
    options.starts = 1;
    double most = 0;
    for (options.firstStart = 1; options.firstStart < 20; ++options.firstStart) {
      const Posture posture = findPosture(setup, options);
      REQUIRE(posture.feasible);
      most = std::max(most, std::abs(posture.q[0] - start));
    }
    CHECK(most > 0.2);
    CHECK(most < 1.1);  // half way to twice the reach of 1.05 m
  }
}

TEST_CASE("random starts of a joint without limits are numbers, and no worse than none") {
  for (const std::string type : {"planar", "floating"}) {
    const PostureScene scene =
        bodiesOf(ball("base") + ball("cart") + ball("hand", 0.3) +
                 joint("p", type, "base", "cart", "<origin xyz='0 0 0.3'/><axis xyz='0 0 1'/>") +
                 joint("j", "revolute", "cart", "hand", kHinge));
    PostureSetup setup = setUp(taskOf(R"({"base": "fixed", "placements": [
        {"link": "hand", "target": {"position": [0, 2, 0.5]}, "free": ["rx", "ry", "rz"]},
        {"link": "hand", "target": {"position": [0, 2.5, 0.5]}, "free": ["rx", "ry", "rz"]}]})"),
                               scene);
    PostureOptions options;
    for (options.firstStart = 0; options.firstStart < 4; ++options.firstStart) {
      const Posture posture = findPosture(setup, options);
      INFO(type << " " << options.firstStart);
      CHECK_FALSE(posture.feasible);
      CHECK(posture.q.allFinite());
      CHECK(std::isfinite(posture.cost));
      REQUIRE(posture.violations.size() >= 2);
      CHECK(posture.violations.front().amount == Approx(0.25).margin(1e-3));
    }
  }
}

TEST_CASE("any number of starts is taken, from any one on") {
  const PostureScene scene = planarArm();
  const std::vector<PostureTask::Place> far{position("tip", {0, 0, 1.31})};
  PostureOptions options;
  for (const int starts : {0, -3, 1}) {
    options.starts = starts;
    for (const int first :
         {0, -5, 1, 100000, std::numeric_limits<int>::max() - 1, std::numeric_limits<int>::max()}) {
      options.firstStart = first;
      const Posture posture = found(scene, far, options);
      INFO(starts << " from " << first);
      CHECK(posture.starts == 1);
      CHECK(posture.q.allFinite());
      CHECK_FALSE(posture.conflict.empty());
    }
  }
  // Starts are the same one by one and in a row, also where their numbers begin again.
  const auto violated = [&](int first, int starts) {
    options.firstStart = first;
    options.starts = starts;
    options.solver.maxIterations = 1;
    return found(scene, {position("tip", {0.5, 0.3, 0.6})}, options).violations.front().amount;
  };
  for (const int first : {0, 99998})
    CHECK(violated(first, 4) == std::min({violated(first, 1), violated(first + 1, 1), violated(first + 2, 1),
                                          violated(first + 3, 1)}));
}

TEST_CASE(
    "a state that moves the base by a virtual joint is refused where the task does not say where it is") {
  PostureScene scene = armAmong("0 9 0");
  Srdf srdf;
  srdf.baseJoint = "world";
  srdf.states = {{"away", "all", {{"world", {5, 0, 1, 0, 0, 0, 1}}, {"j", {0.3}}}},
                 {"home", "all", {{"world", {0, 0, 0, 0, 0, 0, 1}}, {"j", {0.3}}}}};
  scene.srdf = std::make_shared<const Srdf>(srdf);
  const auto task = [](const std::string& base, const std::string& start) {
    return R"({"base": ")" + base + R"(", "start": {)" + start + R"(}, "placements": []})";
  };
  for (const char* base : {"fixed", "planar", "floating"}) {
    CAPTURE(base);
    CHECK_THAT(refusalOf(task(base, R"("state": "away")"), scene),
               Catch::Matchers::Contains("start.state: 'away'") && Catch::Matchers::Contains("'world'") &&
                   Catch::Matchers::Contains("start.base"));
    CHECK(refusalOf(task(base, R"("state": "home")"), scene).empty());
    const PostureSetup setup =
        setUp(taskOf(task(base, R"("state": "away", "base": {"position": [5, 0, 1]})")), scene);
    CHECK(setup.start[setup.start.size() - 1] == 0.3);
    // As in find_posture, which shows the scene relative to the base.
    const auto [moved, around] =
        withBaseAtOrigin(taskOf(task(base, R"("state": "away", "base": {"position": [5, 0, 1]})")), scene);
    CHECK(setUp(moved, around).start == setup.start);
  }
}
