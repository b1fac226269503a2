// Pairs that nothing moves are checked too, and margins of any size are kept.
#include <catch2/catch.hpp>

#include "test/posture/arms.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

namespace {

// A ball on a slide along x, 3 m above a base that does not move, and an obstacle ball around the origin or
// elsewhere.
PostureScene slideAmong(const std::string& obstacle) {
  return bodiesOf(ball("base") + ball("slider") +
                      joint("s", "prismatic", "base", "slider",
                            "<origin xyz='0 0 3'/><axis xyz='1 0 0'/><limit lower='-5' upper='5' effort='1' "
                            "velocity='1'/>"),
                  "<link name='world'/>" + ball("post") +
                      joint("at", "fixed", "world", "post", "<origin xyz='" + obstacle + "'/>"));
}

// A task whose only goal is to stay in place.
Posture stays(const PostureScene& scene, double at, const std::string& collisions,
              const std::string& base = "fixed") {
  PostureSetup setup =
      setUp(parseTask(R"({"base": ")" + base + R"(", "start": {"joints": {"s": )" + std::to_string(at) +
                          R"(}}, "cost": {"towards": "start"}, "placements": [], "collisions": )" +
                          collisions + "}",
                      "task.json"),
            scene);
  return findPosture(setup);
}

}  // namespace

TEST_CASE("a link that nothing moves is checked against obstacles") {
  const PostureScene inside = slideAmong("0 0.02 0");
  for (const std::string collisions : {"{}", R"({"pairs": [{"links": ["base"], "obstacles": ["post"]}]})",
                                       R"({"pairs": [{"obstacles": ["post"]}]})"}) {
    const Posture posture = stays(inside, 1, collisions);
    INFO(collisions);
    CHECK_FALSE(posture.feasible);
    REQUIRE(posture.conflict.size() == 1);
    CHECK(posture.conflict.front().name == "base - post");
    CHECK(posture.conflict.front().amount == Approx(0.08));
    CHECK(posture.violations.size() == 1);
    CHECK(posture.status == "bodies that no joint can move apart collide");
    CHECK(posture.q[0] == Approx(1));  // the achievable part is achieved
  }
  CHECK(stays(inside, 1, R"({"ignore": [{"links": ["base"]}]})").feasible);
  CHECK(stays(inside, 1, R"({"margin": -0.09})").feasible);
  CHECK(stays(slideAmong("0 0.2 0"), 1, R"({"margin": 0.09})").feasible);
  CHECK_FALSE(stays(slideAmong("0 0.2 0"), 1, R"({"margin": 0.11})").feasible);
  // A moving base gets out of the way.
  CHECK(stays(inside, 1, "{}", "planar").feasible);
}

TEST_CASE("pairs that nothing moves count as checked") {
  const PostureSetup setup =
      setUp(parseTask(R"({"base": "fixed", "placements": []})", "task.json"), slideAmong("0 2 0"));
  CHECK(std::count_if(setup.pairs.begin(), setup.pairs.end(), [](const auto& p) { return p.obstacle; }) == 2);
  CHECK(setup.problem->unavoidable().empty());
  CHECK(setup.problem->inequalities() == 1);
}

TEST_CASE("links that are rigidly joined are checked where an SRDF asks for it") {
  PostureScene scene =
      bodiesOf(ball("base") + ball("side") + ball("slider", 1) +
               joint("f", "fixed", "base", "side", "<origin xyz='0.06 0 0'/>") +
               joint("s", "prismatic", "base", "slider",
                     "<axis xyz='1 0 0'/><limit lower='-5' upper='5' effort='1' velocity='1'/>"));
  scene.srdf = std::make_shared<const Srdf>();
  const Posture posture = stays(scene, 1, "{}");
  CHECK_FALSE(posture.feasible);
  REQUIRE(posture.conflict.size() == 1);
  CHECK(posture.conflict.front().name == "base - side");
  CHECK(posture.conflict.front().amount == Approx(0.04));
}

TEST_CASE("a margin is kept, and not exceeded, whatever its size") {
  const PostureScene scene = slideAmong("0 0 3");
  for (const double margin : {-1.0, -0.2, -0.05, 0.0, 0.01, 0.15, 0.3, 0.55, 0.6, 1.0}) {
    const std::string collisions = R"({"margin": )" + std::to_string(margin) + "}";
    INFO(margin);
    const Posture clear = stays(scene, margin + 0.2, collisions);
    CHECK(clear.feasible);
    CHECK(clear.q[0] == Approx(margin + 0.2));
    if (margin < 0) continue;
    const Posture pushed = stays(scene, margin + 0.07, collisions);  // 3 cm too near
    CHECK(pushed.feasible);
    CHECK(pushed.q[0] >= margin + 0.1);
    CHECK(pushed.q[0] < margin + 0.1 + 1e-5);
  }
}
