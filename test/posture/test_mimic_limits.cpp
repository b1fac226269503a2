// Mimic joints keep their own limits, which narrow the limits of the joints that they follow.
#include <catch2/catch.hpp>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/posture/mimic_limits.h"
#include "test/posture/arms.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;

namespace {

std::string limits(double lower, double upper) {
  return "<axis xyz='0 0 1'/><limit lower='" + std::to_string(lower) + "' upper='" + std::to_string(upper) +
         "' effort='1' velocity='1'/>";
}

std::string mimics(const std::string& joint, double multiplier, double offset) {
  return "<mimic joint='" + joint + "' multiplier='" + std::to_string(multiplier) + "' offset='" +
         std::to_string(offset) + "'/>";
}

// A joint `j` of this type and with these limits, and joints that follow it.
PostureScene followed(const std::string& leader, const std::vector<std::string>& followers) {
  std::string text = ball("base") + ball("l", 1) + joint("j", leader, "base", "l", limits(-2, 2));
  for (std::size_t i = 0; i < followers.size(); ++i) {
    const std::string name = "m" + std::to_string(i);
    text += ball(name + "l", 2) + joint(name, "revolute", "l", name + "l", followers[i]);
  }
  return bodiesOf(text);
}

PostureProblem problemOf(const PostureScene& scene) {
  const auto kinematics = std::make_shared<const Kinematics>(scene.robot);
  return PostureProblem(kinematics, quarterCost(*kinematics), kinematics->neutral());
}

std::string refusal(const PostureScene& scene) {
  try {
    problemOf(scene);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

void checkRange(const PostureScene& scene, double lower, double upper) {
  const PostureProblem problem = problemOf(scene);
  CHECK(problem.lower()[0] == Approx(lower).margin(1e-9));
  CHECK(problem.upper()[0] == Approx(upper).margin(1e-9));
}

}  // namespace

TEST_CASE("the limits of mimic joints narrow those of the joint that they follow") {
  checkRange(followed("revolute", {limits(-0.5, 0.7) + mimics("j", 1, 0)}), -0.5, 0.7);
  checkRange(followed("revolute", {limits(-0.5, 0.7) + mimics("j", -2, 0.1)}), -0.3, 0.3);
  checkRange(followed("revolute", {limits(-9, 9) + mimics("j", -2, 0.1)}), -2, 2);
  checkRange(followed("revolute", {limits(-0.5, 9) + mimics("j", 1, 0), limits(-9, 0.4) + mimics("j", 2, 0)}),
             -0.5, 0.2);
  // A chain: m1 = 2 m0 - 0.1, m0 = 0.5 j + 0.2, so m1 = j + 0.3.
  checkRange(
      followed("revolute", {limits(-9, 9) + mimics("j", 0.5, 0.2), limits(-1, 1) + mimics("m0", 2, -0.1)}),
      -1.3, 0.7);
  checkRange(followed("revolute", {limits(-0.5, 0.7) + mimics("j", 0, 0.7)}), -2, 2);
  checkRange(followed("revolute", {limits(0.3, 0.3) + mimics("j", 3, 0)}), 0.1, 0.1);
}

TEST_CASE("a continuous joint turns as far as its mimic joints allow") {
  checkRange(followed("continuous", {limits(-0.5, 0.7) + mimics("j", 1, 0)}), -0.5, 0.7);
  checkRange(followed("continuous", {limits(4, 5) + mimics("j", 1, 0)}), 4, 5);
  checkRange(followed("continuous", {limits(-1, 30) + mimics("j", 1, 0)}), -1, 2 * M_PI - 1);
  checkRange(followed("continuous", {limits(-30, 1) + mimics("j", 1, 0)}), 1 - 2 * M_PI, 1);
  checkRange(followed("continuous", {limits(-30, 30) + mimics("j", 1, 0)}), -M_PI, M_PI);
}

TEST_CASE("limits that leave a joint no value are told with their joints") {
  const std::string none = refusal(followed("revolute", {limits(3, 4) + mimics("j", 1, 0)}));
  CHECK(none.find("r.urdf: joint 'j' keeps within -2 and 2") == 0);
  CHECK(none.find("the joints that mimic it leave no allowed value: 'm0' needs 3 or more, ") !=
        std::string::npos);
  const std::string against =
      refusal(followed("continuous", {limits(1, 2) + mimics("j", 1, 0), limits(-2, -1) + mimics("j", 1, 0)}));
  CHECK(against.find("'m0' needs 1 or more, 'm1' needs -1 or less") != std::string::npos);
  const std::string stays = refusal(followed("revolute", {limits(1, 2) + mimics("j", 0, 0.5)}));
  CHECK(stays.find("'m0' keeps within 1 and 2") != std::string::npos);
  CHECK(stays.find("multiplier 0") != std::string::npos);
}

TEST_CASE("a posture that a mimic joint cannot follow is told with both joints") {
  const PostureScene scene = followed("revolute", {limits(-0.5, 0.5) + mimics("j", 1, 0)});
  PostureTask::Place place = wholePose("l", poseOf(scene, Eigen::VectorXd::Constant(1, 1.5), "l"));
  const Posture posture = found(scene, {place});
  CHECK_FALSE(posture.feasible);
  CHECK(posture.q[0] == Approx(0.5));
  CHECK(posture.conflictLimits == std::vector<std::string>{"j (upper limit by m0)"});
  place = wholePose("l", poseOf(scene, Eigen::VectorXd::Constant(1, 0.4), "l"));
  CHECK(found(scene, {place}).feasible);
}

TEST_CASE("a joint that follows another one has no value of its own in a task") {
  const PostureScene scene = followed("revolute", {limits(-1, 1) + mimics("j", 1, 0)});
  const auto refused = [&](const std::string& joint) {
    PostureTask task;
    task.path = "task.json";
    task.joints = {{joint, 0.5}};
    startOf(task, scene, Kinematics(scene.robot, task.base));
  };
  CHECK_THROWS_WITH(refused("m0"), "task.json: start.joints: 'm0' follows 'j'; give that joint's value");
  CHECK_THROWS_WITH(refused("m00"), Catch::Contains("no joint 'm00' of its own; did you mean 'm0'?"));
}

TEST_CASE("a warning says that no posture keeps the limits of a mimic joint") {
  const auto warned = [](const std::string& follower) {
    return impossibleMimics(Kinematics(followed("revolute", {follower}).robot));
  };
  CHECK(warned(limits(-1, 1) + mimics("j", 1, 0)).empty());
  for (const std::string& follower : {limits(3, 4) + mimics("j", 1, 0), limits(-3, 3) + mimics("j", 0, 5)}) {
    const std::vector<std::string> warnings = warned(follower);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0] == refusal(followed("revolute", {follower})) +
                             ". Until then every verdict is over postures that the robot cannot have.");
  }
}
