// Proofs over joint boxes: no bound is above a sample's distance, and pieces give the same whole in any
// order.
#include <fcl/geometry/shape/sphere.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/body_points.h"
#include "fcl_stpbv/robot/pair_list.h"
#include "fcl_stpbv/robot/pair_proof.h"
#include "fcl_stpbv/robot/pair_search.h"
#include "test/reference/robots.h"
#include "test/robot/bound_trials.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;

namespace {

bool same(const JointBox& a, const JointBox& b) { return a.lower == b.lower && a.upper == b.upper; }

bool same(const PairProof& a, const PairProof& b) {
  return a.boxes == b.boxes && a.collision.has_value() == b.collision.has_value() &&
         (!a.collision || *a.collision == *b.collision) && a.open.size() == b.open.size() &&
         std::equal(a.open.begin(), a.open.end(), b.open.begin(),
                    [](const JointBox& x, const JointBox& y) { return same(x, y); });
}

ProofScene humanoid() {
  LoadedRobot loaded = load(robots()[0]);
  return proofScene(std::make_shared<const Kinematics>(loaded.model),
                    std::make_shared<const RobotGeometry>(std::move(loaded.geometry)), {}, 0);
}

// A chain of links with a turning or sliding joint between each two. Every `each`-th link has the shape.
ProofScene snake(int links, const std::string& shape, int each = 1) {
  std::string text = link("l0", shape);
  for (int i = 1; i < links; ++i) {
    const std::string before = "l" + std::to_string(i - 1), name = "l" + std::to_string(i);
    text += link(name, i % each == 0 ? shape : "") +
            joint("j" + std::to_string(i), i % 5 == 0 ? "prismatic" : "revolute", before, name,
                  std::string("<origin xyz=\"0 0.01 0.2\" rpy=\"0.1 0.05 0\"/><axis xyz=\"") +
                      (i % 2 == 0 ? "1 0 0" : "0 1 0.3") + "\"/>");
  }
  return proofSceneOf(robot(text));
}

LinkPair pairNamed(const ProofScene& scene, const std::string& one, const std::string& other) {
  const RobotModel& robot = scene.kinematics->robot();
  return {robot.link(one), robot.link(other)};
}

}  // namespace

TEST_CASE("no distance in a box is below the box's bound") {
  Random random(5);
  const ProofScene primitives = primitiveScene();
  const BoundTrials simple = tryBounds(primitives, movingPairs(primitives), 3000, random);
  CHECK(simple.samples == 24000);
  CHECK(simple.violations == 0);
  CHECK(simple.useful > 0.2);  // otherwise the test would show nothing
  const ProofScene robot = humanoid();
  const BoundTrials meshes = tryBounds(robot, movingPairs(robot), 2000, random);
  CHECK(meshes.violations == 0);
  CHECK(meshes.useful > 0.2);
}

TEST_CASE("bounds hold across more joints than third-order terms are weighed for") {
  const ProofScene scene = snake(40, "<box size=\"0.06 0.05 0.1\"/>");
  Random random(7);
  const BoundTrials trials = tryBounds(scene, {{0, 39}, {3, 36}, {0, 27}, {10, 39}}, 1500, random);
  CHECK(trials.samples == 12000);
  CHECK(trials.violations == 0);
  CHECK(trials.useful > 0.1);  // otherwise the test would show nothing
}

TEST_CASE("bounds hold where a joint follows another one with the multiplier 0") {
  // The joint's frame does not move while the joint that it follows turns `b` towards `c`.
  const std::string bar = "<box size=\"0.1 0.1 0.6\"/>";
  const ProofScene scene = proofSceneOf(robot(
      link("a") + link("b", bar) + link("c", bar) +
      joint("turn", "revolute", "a", "b", "<origin xyz=\"0.25 0 0\"/><axis xyz=\"0 1 0\"/>") +
      joint("still", "revolute", "a", "c", "<axis xyz=\"0 1 0\"/><mimic joint=\"turn\" multiplier=\"0\"/>")));
  Random random(13);
  for (const LinkPair& pair : {LinkPair{1, 2}, LinkPair{2, 1}}) {
    const BoundTrials trials = tryBounds(scene, {pair}, 300, random);
    CHECK(trials.violations == 0);
    CHECK(trials.useful > 0.2);
    CHECK(provePair(scene, pair, unproven(scene, pair).open, 1000).collision);
  }
}

TEST_CASE("a bound holds where a joint follows another one by a multiplier of a few subnormal units") {
  // `c` turns towards `a`. The joint between the two stands still, but its share of the range is rounded.
  const ProofScene scene = proofSceneOf(
      robot(link("a", "<sphere radius=\"3\"/>") + link("b") +
            "<link name=\"c\"><collision><origin xyz=\"1 0 0\"/><geometry><sphere radius=\"0.1\"/></geometry>"
            "</collision></link>" +
            joint("follow", "revolute", "a", "b",
                  "<origin xyz=\"-0.77 -3.8 0\"/><axis xyz=\"0 0 1\"/><mimic joint=\"turn\" "
                  "multiplier=\"1e-323\"/>") +
            joint("turn", "revolute", "b", "c", "<axis xyz=\"0 0 1\"/>")));
  constexpr double kTurn = 0.7;
  const double least = std::hypot(std::cos(kTurn) - 0.77, std::sin(kTurn) - 3.8) - 3.1;
  const JointBox box{Eigen::VectorXd::Constant(1, -kTurn), Eigen::VectorXd::Constant(1, kTurn)};
  const double bound = distanceBound(scene, pairNamed(scene, "a", "c"), box);
  CHECK(bound <= least);
  CHECK(bound > 0.5 * least);
}

TEST_CASE("pairs far along a robot are settled with fewer boxes, as each takes longer, and stay checked") {
  const ProofScene scene = snake(49, "<sphere radius=\"0.05\"/>", 48);
  PairListOptions options;
  options.samples = 1;
  options.descents = options.randomDescents = 0;
  const std::vector<PairEntry> list = pairList(scene.kinematics, scene.geometry, nullptr, options);
  REQUIRE(list.size() == 1);
  CHECK(list[0].boxes == 25);  // 200 / 2^3
  CHECK(list[0].reason == PairReason::neverSampled);
  CHECK(checkedWithoutSrdf(list[0].reason));
}

TEST_CASE("a proof in pieces is the proof in one, and its pieces are put together in any order") {
  const ProofScene scene = primitiveScene();
  std::mt19937 shuffle(3);
  int proven = 0;
  for (const LinkPair& pair : movingPairs(scene)) {
    const PairProof start = unproven(scene, pair);
    const PairProof whole = provePair(scene, pair, start.open, 3000);
    PairProof resumed = start;
    for (int piece = 0; piece < 3000 && !resumed.open.empty() && resumed.boxes < 3000; ++piece) {
      const long before = resumed.boxes;
      resumed = provePair(scene, pair, std::move(resumed.open), std::min(7L, 3000 - before));
      resumed.boxes += before;
    }
    CHECK(same(whole, resumed));
    proven += whole.proven();
    // Each box of an early state separately, as workers would get them.
    std::vector<PairProof> pieces;
    for (const JointBox& box : provePair(scene, pair, start.open, 20).open)
      pieces.push_back(provePair(scene, pair, {box}, 50));
    if (pieces.size() < 3) continue;
    PairProof inOrder, nested;
    for (const PairProof& piece : pieces) inOrder = merge(inOrder, piece);
    for (std::size_t i = pieces.size(); i-- > 0;) nested = merge(pieces[i], nested);
    CHECK(same(inOrder, nested));
    for (int round = 0; round < 5; ++round) {
      std::shuffle(pieces.begin(), pieces.end(), shuffle);
      PairProof left, right;
      for (std::size_t i = 0; i < pieces.size(); ++i) {
        PairProof& half = i < pieces.size() / 2 ? left : right;
        half = merge(pieces[i], half);
      }
      CHECK(same(merge(right, left), inOrder));
    }
  }
  CHECK(proven > 0);
}

TEST_CASE("a collision that a proof finds is one, and ends it") {
  const ProofScene scene = humanoid();
  const LinkPair pair = pairNamed(scene, "CHEST_LINK1", "LARM_LINK5");
  const PairProof proof = provePair(scene, pair, unproven(scene, pair).open, 20000);
  REQUIRE(proof.collision);
  CHECK(proof.open.empty());
  CHECK_FALSE(proof.proven());
  PairSearch search(scene.kinematics, scene.geometry, pair);
  CHECK(search.distance(*proof.collision) <= 0);
  CHECK((*proof.collision - scene.kinematics->lower()).minCoeff() >= 0);
  CHECK((scene.kinematics->upper() - *proof.collision).minCoeff() >= 0);
}

TEST_CASE("an arm's proof against the other arm takes few boxes: products of turns are weighed together") {
  const ProofScene scene = humanoid();
  const LinkPair pair = pairNamed(scene, "RARM_LINK2", "LARM_LINK4");
  const PairProof proof = provePair(scene, pair, unproven(scene, pair).open, 2500);
  CHECK(proof.proven());  // in 1,707 boxes; if the products are bounded one by one, 3,749
}

TEST_CASE(
    "one coordinate that turns and slides a body: no bound is above a distance, beyond half a turn either "
    "way") {
  // A rack carries the pinion that drives it, with a ball at the pinion's rim, towards a wall. The ball's
  // centre is at x = c t - l sin(t), which grows by more past a quarter turn than the sine shows.
  Random random(6);
  double highest = -1;
  for (int i = 0; i < 300; ++i) {
    const double c = random.uniform(0.05, 0.4), l = random.uniform(0.05, 0.4),
                 half = random.uniform(1.6, 3.1);
    const auto number = [](double x) { return std::to_string(x); };
    const ProofScene scene = proofSceneOf(robot(
        "<link name=\"wall\"><collision><origin xyz=\"2 0 0\"/><geometry><box size=\"0.2 4 4\"/></geometry>"
        "</collision></link>" +
        link("rack") + "<link name=\"ball\"><collision><origin xyz=\"0 " + number(l) +
        " 0\"/><geometry><sphere radius=\"0.05\"/></geometry></collision></link>" +
        joint("slide", "prismatic", "wall", "rack",
              "<axis xyz=\"1 0 0\"/><mimic joint=\"turn\" multiplier=\"" + number(c) + "\"/>", 9) +
        joint("turn", "revolute", "rack", "ball", "<axis xyz=\"0 0 1\"/>", 9)));
    JointBox box{Eigen::VectorXd::Constant(1, -half), Eigen::VectorXd::Constant(1, half)};
    const double bound = distanceBound(scene, pairNamed(scene, "wall", "ball"), box);
    double least = 1e9;
    for (int k = 0; k <= 1000; ++k) {
      const double t = half * (k / 500.0 - 1);
      least = std::min(least, 1.9 - 0.05 - (std::stod(number(c)) * t - std::stod(number(l)) * std::sin(t)));
    }
    CAPTURE(c, l, half);
    CHECK(bound <= least + 1e-12);
    highest = std::max(highest, bound - least);
  }
  CHECK(highest > -0.01);  // the bound is close to the distance
}

TEST_CASE("a proof of links without bodies, of what does not exist and of other boxes is refused") {
  const ProofScene scene = primitiveScene();
  const LinkPair pair = movingPairs(scene).front();
  for (const LinkPair& wrong :
       {LinkPair{-1, 1}, LinkPair{0, 99}, LinkPair{1, 99, true}, LinkPair{1, -1, true}}) {
    CHECK_THROWS_AS(unproven(scene, wrong), Error);
    CHECK_THROWS_AS(provePair(scene, wrong, unproven(scene, pair).open, 1), Error);
  }
  const JointBox wide{Eigen::VectorXd::Zero(9), Eigen::VectorXd::Ones(9)};
  CHECK_THROWS_AS(distanceBound(scene, pair, wide), Error);
  CHECK_THROWS_AS(provePair(scene, pair, {wide}, 1), Error);
  JointBox turned = unproven(scene, pair).open[0];  // an empty box, which would be proven at once
  turned.lower.swap(turned.upper);
  CHECK_THROWS_WITH(provePair(scene, pair, {turned}, 1), Catch::Matchers::Contains("lower limit above"));
  CHECK_THROWS_AS(distanceBound(scene, pair, turned), Error);
  JointBox unknown = unproven(scene, pair).open[0];
  unknown.upper[0] = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(provePair(scene, pair, {unknown}, 1), Catch::Matchers::Contains("not a number"));
  CHECK_THROWS_AS(distanceBound(scene, pair, unknown), Error);
}

TEST_CASE(
    "depths for which the bodies are too thin are proven in one box, and depths that they reach are found") {
  // Two plates that slide and turn through each other. They are at most 0.35 m deep, where they cross.
  const std::string plate = "<box size=\"0.1 0.6 0.4\"/>";
  const std::string text =
      robot(link("a", plate) + link("m") + link("b", plate) + joint("x", "prismatic", "a", "m") +
            joint("t", "continuous", "m", "b", "<axis xyz=\"0 0 1\"/>"));
  const auto proofAt = [&](double margin) {
    ProofScene scene = proofSceneOf(text);
    scene.margin = margin;
    return provePair(scene, {0, 2}, unproven(scene, {0, 2}).open, 100);
  };
  const PairProof deep = proofAt(-0.6);
  CHECK(deep.proven());
  CHECK(deep.boxes == 1);
  CHECK(proofAt(-0.099).collision);
  // No depth that a search finds may exceed the bound.
  const ProofScene primitives = primitiveScene();
  Random random(11);
  for (const LinkPair& pair : movingPairs(primitives)) {
    const Body
        &a = primitives.geometry->bodies[static_cast<std::size_t>(primitives.geometry->of(pair.link1).first)],
        &b = primitives.geometry->bodies[static_cast<std::size_t>(primitives.geometry->of(pair.link2).first)];
    const auto first = bodyPoints(*a.geometry, a.pose), second = bodyPoints(*b.geometry, b.pose);
    REQUIRE((first && second));
    for (int i = 0; i < 50; ++i) {
      const Eigen::Isometry3d pose(Eigen::Quaterniond(random.rotation()));
      const DistanceAnswer answer = distance(*a.geometry, Eigen::Isometry3d::Identity(), *b.geometry, pose);
      CHECK(-answer.upper <= mostDepth(*first, *second));
    }
  }
}

TEST_CASE("joints without limits leave a pair unproven, a rigid pair needs one box") {
  const std::string ball = "<sphere radius=\"0.1\"/>";
  const ProofScene scene = proofSceneOf(robot(link("a", ball) + link("b", ball) + link("c", ball) +
                                              joint("f", "floating", "a", "b") +
                                              joint("g", "fixed", "a", "c", "<origin xyz=\"1 0 0\"/>")));
  const PairProof floating = provePair(scene, {0, 1}, unproven(scene, {0, 1}).open, 100);
  CHECK(floating.boxes == 0);
  CHECK(floating.open.size() == 1);
  const PairProof rigid = provePair(scene, {0, 2}, unproven(scene, {0, 2}).open, 100);
  CHECK(rigid.boxes == 1);
  CHECK(rigid.proven());
}

TEST_CASE("limits that a box sets itself make no bound across planar and floating joints and moving bases") {
  const std::string ball = "<sphere radius=\"0.1\"/>";
  for (const std::string type : {"planar", "floating"}) {
    const ProofScene scene =
        proofSceneOf(robot(link("a", ball) + link("b", ball) +
                           joint("p", type, "a", "b", "<origin xyz=\"2 0 0\"/><axis xyz=\"0 0 1\"/>")));
    const Eigen::VectorXd room = Eigen::VectorXd::Constant(scene.kinematics->size(), 3);
    for (const double wide : {0.0, 1.0}) {  // the bodies meet within the wide one
      const JointBox box{-wide * room, wide * room};
      CHECK(distanceBound(scene, {0, 1}, box) == -std::numeric_limits<double>::infinity());
      CHECK(provePair(scene, {0, 1}, {box}, 100).open.size() == 1);
    }
  }
  const ProofScene still =
      proofSceneOf(robot(link("a", ball) + link("b", ball) + joint("p", "revolute", "a", "b")));
  const fcl::CollisionObjectd wall(std::make_shared<fcl::Sphered>(0.1),
                                   fcl::Transform3d(Eigen::Translation3d(2, 0, 0)));
  const ProofScene moving =
      proofScene(std::make_shared<const Kinematics>(
                     std::make_shared<const RobotModel>(still.kinematics->robot()), BaseMotion::planar),
                 still.geometry, {obstacleOf(wall, "wall")}, 0);
  const JointBox box{Eigen::Vector4d::Constant(-3), Eigen::Vector4d::Constant(3)};
  CHECK(distanceBound(moving, {1, 0, true}, box) == -std::numeric_limits<double>::infinity());
  CHECK_FALSE(provePair(moving, {1, 0, true}, {box}, 100).proven());
}

TEST_CASE(
    "limits next to the largest double are halved, and where nothing can be measured nothing collides") {
  const std::string ball = "<sphere radius=\"0.1\"/>";
  const ProofScene scene = proofSceneOf(
      robot(link("a", ball) + link("b", ball) +
            joint("slide", "prismatic", "a", "b", "<origin xyz=\"0 2 0\"/><axis xyz=\"1 0 0\"/>")));
  for (const double far : {1e149, 1e300, 1e308, 1.7e308}) {
    const JointBox box{Eigen::VectorXd::Constant(1, 0.9 * far), Eigen::VectorXd::Constant(1, far)};
    const PairProof proof = provePair(scene, {0, 1}, {box}, 50);
    CHECK_FALSE(proof.collision);
    const JointBox both{-box.upper, box.upper};
    const PairProof around = provePair(scene, {0, 1}, {both}, 50);
    CHECK_FALSE(around.collision);
    for (const JointBox& open : around.open) CHECK((open.lower.allFinite() && open.upper.allFinite()));
  }
  PairProof many;
  many.boxes = std::numeric_limits<long>::max();
  CHECK(merge(many, many).boxes == many.boxes);
}

TEST_CASE("a box in which a joint slides beyond its limits is not proven by levers within them") {
  // The ball on the slide would meet the other one 2.9 m beyond the slide's limits.
  const std::string ball = "<geometry><sphere radius=\"0.1\"/></geometry></collision></link>";
  const ProofScene scene = proofSceneOf(robot(
      "<link name=\"a\"><collision><origin xyz=\"0 3 0\"/>" + ball + link("m") +
      "<link name=\"b\"><collision>" + ball + joint("turn", "continuous", "a", "m", "<axis xyz=\"0 0 1\"/>") +
      joint("slide", "prismatic", "m", "b", "<axis xyz=\"1 0 0\"/>", 0)));
  const JointBox box{Eigen::Vector2d(0, 2.9), Eigen::Vector2d(3, 2.9)};
  CHECK(provePair(scene, {0, 2}, {box}, 1000).collision);
}

TEST_CASE("no bound is above a distance where a mimic joint has made many turns, whose angle is rounded") {
  // `b` swings 0.5 m around the axis. The wall's ball is 2 m away.
  const std::string ball = "<geometry><sphere radius=\"0.1\"/></geometry></collision></link>";
  const double multiplier = 0.7371234567891234;
  const ProofScene scene = proofSceneOf(
      robot("<link name=\"a\"><collision><origin xyz=\"2 0 0\"/>" + ball + link("leader") +
            "<link name=\"b\"><collision><origin xyz=\"0.5 0 0\"/>" + ball +
            joint("turn", "continuous", "a", "leader", "<axis xyz=\"0 0 1\"/>") +
            joint("follow", "continuous", "a", "b",
                  "<axis xyz=\"0 0 1\"/><mimic joint=\"turn\" multiplier=\"0.7371234567891234\"/>")));
  REQUIRE(scene.kinematics->upper()[0] >= 1e6);
  Random random(17);
  double highest = -1;
  for (int i = 0; i < 300; ++i) {
    const double q = random.uniform(1e5, 1e6);
    const JointBox box{Eigen::VectorXd::Constant(1, q), Eigen::VectorXd::Constant(1, q)};
    const double bound = distanceBound(scene, pairNamed(scene, "a", "b"), box);
    const long double angle = static_cast<long double>(multiplier) * q;
    const long double x = 0.5L * std::cos(angle) - 2, y = 0.5L * std::sin(angle);
    const long double truth = std::sqrt(x * x + y * y) - 0.2L;
    CHECK(bound <= truth);
    highest = std::max(highest, static_cast<double>(bound - truth));
  }
  CHECK(highest > -1e-8);  // the bound is close to the distance
}
