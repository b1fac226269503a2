// Obstacles without an end, of no known size or of kilometres: pairs beside them are searched as without
// them, and their own pairs are searched and proven as far as anything is known.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/plane.h>
#include <fcl/geometry/shape/sphere.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/robot/pair_list.h"
#include "fcl_stpbv/robot/pair_proof.h"
#include "test/robot/arm.h"
#include "test/robot/bound_trials.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;

namespace {

// Three balls of 0.1 m on an arm, 0.5 m apart. The joints turn by at most 1 rad about y: the first and the
// last ball never meet.
Arm ballsOnArm(BaseMotion base = BaseMotion::fixed) {
  const std::string ball = "<sphere radius=\"0.1\"/>";
  const auto turn = [](const std::string& name, const std::string& parent, const std::string& child) {
    return joint(name, "revolute", parent, child, "<origin xyz=\"0.5 0 0\"/><axis xyz=\"0 1 0\"/>");
  };
  return armFrom(parsed(robot(link("a", ball) + link("b", ball) + link("c", ball) + turn("j1", "a", "b") +
                              turn("j2", "b", "c"))),
                 base);
}

std::vector<PairEntry> listOf(const Arm& arm, const std::vector<Obstacle>& obstacles) {
  PairListOptions options;
  options.samples = 300;
  options.obstacles = obstacles;
  return pairList(arm.kinematics, arm.geometry, nullptr, options);
}

Obstacle floorAt(double z, const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity()) {
  return {"floor", std::make_shared<fcl::Halfspaced>(Eigen::Vector3d(0, 0, 1), z), pose};
}

template <class Shape>
Obstacle boxed(const std::string& name, const std::shared_ptr<Shape>& shape, const Eigen::Vector3d& where) {
  return {name, shape, Eigen::Isometry3d(Eigen::Translation3d(where))};
}

}  // namespace

TEST_CASE("obstacles without a size do not change the search of the others") {
  const auto unmeasured = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();  // no computeLocalAABB()
  unmeasured->beginModel();
  unmeasured->addTriangle({-0.5, -0.5, -2}, {0.5, -0.5, -2}, {0, 0.5, -2});
  unmeasured->endModel();
  Eigen::Isometry3d notRigid = Eigen::Isometry3d::Identity();
  notRigid.linear() *= 1.1;
  const Obstacle triangle{"triangle", unmeasured},
      floor = floorAt(-2), nowhere{"nowhere", std::make_shared<fcl::Sphered>(0.1), notRigid};
  CHECK(triangle.radius() < 3);
  for (const BaseMotion base : {BaseMotion::fixed, BaseMotion::planar, BaseMotion::floating}) {
    const Arm arm = ballsOnArm(base);
    for (const Obstacle& obstacle : {triangle, floor, nowhere}) {
      CAPTURE(static_cast<int>(base), obstacle.name);
      for (const PairEntry& entry : listOf(arm, {obstacle})) {
        CHECK(entry.closest.allFinite());
        if (!entry.obstacle && entry.link1 == 0 && entry.link2 == 2) {
          CHECK(entry.reason == PairReason::neverProven);
          CHECK(entry.minDistance > 0.5);
        }
        if (!entry.obstacle) continue;
        if (obstacle.name == "nowhere")
          CHECK(entry.reason == PairReason::always);
        else if (base == BaseMotion::floating)  // a planar base stays above
          CHECK(entry.reason == PairReason::sometimes);
        else
          CHECK_FALSE(entry.minDistance <= 0);
      }
    }
  }
}

TEST_CASE("a body whose sphere is not known is searched and proven by the ball around its shape") {
  const Arm arm = ballsOnArm();
  RobotGeometry unknown = *arm.geometry;
  unknown.bodies[0].radius = std::numeric_limits<double>::infinity();
  const std::vector<PairEntry> expected = listOf(arm, {}),
                               found = listOf(
                                   {arm.kinematics, std::make_shared<const RobotGeometry>(unknown)}, {});
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CHECK(found[i].reason == expected[i].reason);
    CHECK(found[i].minDistance == expected[i].minDistance);
    CHECK(found[i].boxes == expected[i].boxes);
  }
}

TEST_CASE("a floor of kilometres does not hide a pillar beside the robot") {
  const Arm arm = ballsOnArm(BaseMotion::floating);
  const auto large = std::make_shared<fcl::Boxd>(20000, 20000, 0.2),
             slim = std::make_shared<fcl::Boxd>(0.2, 0.2, 2);
  const std::vector<PairEntry> list =
      listOf(arm, {boxed("pillar", slim, {2, 1, 0}), boxed("floor", large, {0, 0, -2.1})});
  CHECK(std::count_if(list.begin(), list.end(), [](const PairEntry& e) {
          return e.obstacle && e.reason == PairReason::sometimes;
        }) == 6);
}

TEST_CASE("a floor without an end is proven to be out of reach") {
  const Arm arm = ballsOnArm();
  const auto proofOf = [&](const Obstacle& obstacle) {
    const ProofScene scene = proofScene(arm.kinematics, arm.geometry, {obstacle}, 0);
    return provePair(scene, {2, 0, true}, unproven(scene, {2, 0, true}).open, 100);
  };
  const PairProof far = proofOf(floorAt(-50));
  CHECK(far.proven());
  CHECK(far.boxes == 1);
  CHECK(proofOf(floorAt(-0.6)).proven());  // the ball reaches down to -0.1 - 0.5 sin(1) = -0.52
  CHECK(proofOf(floorAt(-0.51)).collision);
  const auto wall = std::make_shared<fcl::Planed>(Eigen::Vector3d(1, 0, 0), 1.2);
  CHECK(proofOf({"wall", wall}).proven());  // the ball reaches to 1.1
  // The same floor by a pose and an offset that cancel each other.
  CHECK(proofOf(floorAt(-1e6, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1e6 - 2)))).proven());
}

TEST_CASE("no distance of a half space or a plane in a box is below the box's bound") {
  const ProofScene simple = primitiveScene();
  const ProofScene scene = proofScene(
      simple.kinematics, simple.geometry,
      {floorAt(-0.5), {"wall", std::make_shared<fcl::Planed>(Eigen::Vector3d(3, 4, 0).normalized(), 1.3)}},
      0);
  std::vector<LinkPair> pairs = movingPairs(scene);
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), [](const LinkPair& p) { return !p.obstacle; }),
              pairs.end());
  Random random(3);
  const BoundTrials trials = tryBounds(scene, pairs, 1000, random);
  CHECK(trials.violations == 0);
  CHECK(trials.useful > 0.1);  // otherwise the test would show nothing
}
