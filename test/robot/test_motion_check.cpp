// Motions of robots that are proven free: compared with dense samples of every pair and a closed form, with
// joints of all kinds.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/geometric_shape_to_BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/sphere.h>

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/constraints.h"
#include "fcl_stpbv/robot/motion_chains.h"
#include "fcl_stpbv/robot/motion_check.h"
#include "test/reference/fcl_bodies.h"
#include "test/reference/robots.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::VectorXd;

namespace {

/// The least of all rows at q, from the constraints, which do not use motions.
double leastAt(CollisionConstraints& rows, const VectorXd& q) {
  VectorXd d(rows.rows());
  rows.evaluate(q, d);
  return d.minCoeff();
}

/// Chains with every type of joint, including a mimic joint, and balls at their ends.
const char* const kJoints = R"(<robot name="joints">
  <link name="root"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="a"><collision><geometry><sphere radius="0.05"/></geometry></collision></link>
  <link name="b"><collision><origin xyz="0 0 0.2"/><geometry><box size="0.05 0.1 0.3"/></geometry></collision></link>
  <link name="c"><collision><origin xyz="0.1 0 0"/><geometry><cylinder radius="0.05" length="0.2"/></geometry></collision></link>
  <link name="d"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="e"><collision><origin xyz="0.2 0 0"/><geometry><box size="0.3 0.05 0.05"/></geometry></collision></link>
  <joint name="slide" type="prismatic"><parent link="root"/><child link="a"/><origin xyz="0.2 0 0" rpy="0.3 0.2 0.1"/>
    <axis xyz="0 1 0"/><limit lower="-0.5" upper="0.5" effort="1" velocity="1"/></joint>
  <joint name="turn" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0.1 0.05 0" rpy="0.5 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="follow" type="revolute"><parent link="b"/><child link="c"/><origin xyz="0 0 0.4"/>
    <axis xyz="1 0 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/><mimic joint="turn" multiplier="-0.7" offset="0.2"/></joint>
  <joint name="plane" type="planar"><parent link="root"/><child link="d"/><origin xyz="0 0 0.5" rpy="0.1 0.2 0.3"/><axis xyz="0 0 1"/></joint>
  <joint name="float" type="floating"><parent link="d"/><child link="e"/><origin xyz="-0.2 0 0"/></joint>
</robot>)";

std::shared_ptr<fcl::BVHModel<fcl::OBBRSSd>> meshOfBox(double x, double y, double z) {
  auto mesh = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  fcl::generateBVHModel(*mesh, fcl::Boxd(x, y, z), Eigen::Isometry3d::Identity());
  return mesh;
}

struct Scene {
  std::shared_ptr<const RobotModel> model;
  std::shared_ptr<const Kinematics> kinematics;
  std::shared_ptr<const RobotGeometry> geometry;
  std::vector<Obstacle> obstacles;
  std::vector<CheckedPair> pairs;
};

Scene everyJoint(BaseMotion base) {
  Scene scene;
  auto [model, geometry] = parsed(kJoints);
  scene.model = model;
  for (Body& body : geometry.bodies)
    if (scene.model->links[static_cast<std::size_t>(body.link)].name == "e")
      body.geometry = meshOfBox(0.3, 0.05, 0.05);
  scene.geometry = std::make_shared<const RobotGeometry>(std::move(geometry));
  scene.kinematics = std::make_shared<const Kinematics>(scene.model, base);
  const auto mesh = meshOfBox(0.3, 0.3, 0.3);
  const auto place = [](double x, double y, double z) {
    return pose(Eigen::Matrix3d::Identity(), {x, y, z});
  };
  scene.obstacles.push_back(obstacleOf(fcl::CollisionObjectd(mesh, place(0.6, 0.6, 0.4)), "mesh"));
  scene.obstacles.push_back(obstacleOf(
      fcl::CollisionObjectd(std::make_shared<fcl::Boxd>(0.2, 0.2, 0.2), place(-0.5, 0.4, 0.3)), "box"));
  scene.obstacles.push_back(
      obstacleOf(fcl::CollisionObjectd(
                     std::make_shared<fcl::Halfspaced>(Eigen::Vector3d(0, 0, 1), -0.9),
                     pose(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()).toRotationMatrix(), {0, 0, 0})),
                 "floor"));
  scene.pairs = selfPairs(*scene.model, *scene.geometry, nullptr);
  const auto around =
      obstaclePairs(*scene.model, *scene.geometry, scene.obstacles.size(), base != BaseMotion::fixed);
  scene.pairs.insert(scene.pairs.end(), around.begin(), around.end());
  return scene;
}

/// Compares a random motion's verdict with samples, and counts the verdicts.
void compare(MotionCheck& check, CollisionConstraints& rows, const VectorXd& q0, const VectorXd& q1,
             double margin, int samples, int& free, int& hits) {
  const double tolerance = 1e-5;
  const MotionBracket found = check.firstContact(q0, q1, {margin, tolerance});
  const bool isFree = check.isMotionFree(q0, q1, margin);
  CHECK(isFree == (found.verdict == MotionVerdict::free));
  REQUIRE(found.verdict != MotionVerdict::undecided);
  const auto at = [&](double t) { return leastAt(rows, q0 + t * (q1 - q0)); };
  for (int i = 0; i <= samples; ++i) {
    const double t = static_cast<double>(i) / samples;
    if (t >= found.from) break;
    REQUIRE(at(t) > margin - 1e-12);
  }
  if (found.verdict == MotionVerdict::free) {
    ++free;
    CHECK(at(1) > margin - 1e-12);
  } else {
    ++hits;
    CHECK(found.until - found.from <= tolerance);
    CHECK(at(found.until) <= margin + 1e-12);
    CHECK(check.answer(found.pair, q0 + found.until * (q1 - q0)).distance <= margin + 1e-12);
  }
}

}  // namespace

TEST_CASE(
    "motions through joints of every type, among a mesh, a box and a floor, are judged as dense samples see "
    "them") {
  Random random(1);
  for (const BaseMotion base : {BaseMotion::fixed, BaseMotion::planar, BaseMotion::floating}) {
    const Scene scene = everyJoint(base);
    MotionCheck check(scene.kinematics, scene.geometry, scene.pairs, scene.obstacles);
    ConstraintOptions options;
    options.obstacles = scene.obstacles;
    CollisionConstraints rows(scene.kinematics, scene.geometry, scene.pairs, options);
    int free = 0, hits = 0;
    for (int i = 0; i < 300; ++i) {
      CAPTURE(i, static_cast<int>(base));
      const VectorXd q0 = randomConfiguration(*scene.kinematics, random);
      // Samples are 0.007 rad or m apart, or less.
      const auto which = static_cast<std::size_t>(i % 3);
      const double size = std::array{2.0, 0.3, 0.05}[which];
      const int samples = std::array{300, 75, 25}[which];
      compare(check, rows, q0, q0 + size * randomDirection(q0.size(), random), i % 2 ? 0.0 : 0.01, samples,
              free, hits);
    }
    CHECK((free > 30 && hits > 30));
  }
}

TEST_CASE("short edges of a humanoid: none that samples see collide is called free") {
  const Problem p = problem(robots().front());
  MotionCheck check(p.kinematics, p.geometry, p.pairs);
  CollisionConstraints rows(p.kinematics, p.geometry, p.pairs);
  Random random(2);
  int free = 0, hits = 0;
  for (int i = 0; i < 60; ++i) {
    CAPTURE(i);
    const VectorXd q0 = 0.3 * randomConfiguration(*p.kinematics, random);
    const VectorXd range = (p.kinematics->upper() - p.kinematics->lower()).cwiseMin(2 * M_PI);
    const VectorXd q1 = q0 + 0.05 * range.cwiseProduct(randomDirection(q0.size(), random).cwiseSign());
    compare(check, rows, q0, q1, 0, 50, free, hits);
    CHECK(check.isFree(q0) == (leastAt(rows, q0) > 0));
  }
  CHECK((free > 5 && hits > 0));
}

TEST_CASE("the closest approach of each pair is within its precision of what samples find, and never above") {
  const Scene scene = everyJoint(BaseMotion::fixed);
  MotionCheck check(scene.kinematics, scene.geometry, scene.pairs, scene.obstacles);
  ConstraintOptions options;
  options.obstacles = scene.obstacles;
  CollisionConstraints rows(scene.kinematics, scene.geometry, scene.pairs, options);
  Random random(3);
  VectorXd d(rows.rows());
  for (int i = 0; i < 20; ++i) {
    const VectorXd q0 = randomConfiguration(*scene.kinematics, random),
                   q1 = q0 + 0.5 * randomDirection(q0.size(), random);
    std::vector<Approach> best;
    const double precision = 1e-5;
    if (!check.closest(q0, q1, precision, 0, best)) continue;  // too deep to be proven
    VectorXd least = VectorXd::Constant(rows.rows(), 1e9);
    for (int k = 0; k <= 500; ++k) {
      rows.evaluate(q0 + k / 500.0 * (q1 - q0), d);
      least = least.cwiseMin(d);
    }
    for (int row = 0; row < rows.rows(); ++row) {
      CAPTURE(i, rows.name(row));
      const Approach& found = best[static_cast<std::size_t>(row)];
      CHECK(found.distance - precision <= least[row]);
      rows.evaluate(q0 + found.time * (q1 - q0), d);
      CHECK(std::abs(found.distance - d[row]) <= 1e-9);
    }
  }
}

TEST_CASE("a link that slides over a flat mesh takes few looks, however near, and meets a floor in time") {
  const char* const gantry =
      R"(<robot name="gantry"><link name="base"/><link name="rail"/><link name="wrist"/>
    <link name="tool"><collision><geometry><box size="0.1 0.08 0.06"/></geometry></collision></link>
    <joint name="along" type="prismatic"><parent link="base"/><child link="rail"/><axis xyz="1 0 0"/>
      <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
    <joint name="up" type="prismatic"><parent link="rail"/><child link="wrist"/><axis xyz="0 0 1"/>
      <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
    <joint name="turn" type="revolute"><parent link="wrist"/><child link="tool"/><axis xyz="0 0 1"/>
      <limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>)";
  const auto model = std::make_shared<const RobotModel>(parseUrdf(gantry, "gantry.urdf"));
  const auto kinematics = std::make_shared<const Kinematics>(model);
  RobotGeometry geometry = loadGeometry(*model);
  const auto check = [&](std::shared_ptr<fcl::CollisionGeometryd> obstacle) {
    const fcl::CollisionObjectd object(std::move(obstacle), Eigen::Isometry3d::Identity());
    return MotionCheck(kinematics, std::make_shared<const RobotGeometry>(geometry), {{0, 0, true}},
                       {obstacleOf(object, "floor")});
  };
  const auto halfSpace = [] { return std::make_shared<fcl::Halfspaced>(Eigen::Vector3d::UnitZ(), 0); };
  for (const bool meshLink : {false, true}) {
    if (meshLink) geometry.bodies[0].geometry = meshOfBox(0.1, 0.08, 0.06);
    for (const bool meshFloor : {false, true}) {
      CAPTURE(meshLink, meshFloor);
      MotionCheck floor = meshFloor ? check(bumpyGround<fcl::OBBRSSd>(10, 0)) : check(halfSpace());
      for (const double room : {1e-3, 1e-6})
        for (const double turn : {0.0, 0.8}) {
          CAPTURE(room, turn);
          const Eigen::Vector3d q0(-0.1, 0.03 + room, 0), q1(0.1, 0.03 + room, turn),
              below(0.1, 0.03 - room, turn);
          const MotionBracket slide = floor.firstContact(q0, q1);
          CHECK(slide.verdict == MotionVerdict::free);
          CHECK(slide.queries < 10);
          std::vector<Approach> best;
          CHECK(floor.closest(q0, q1, 1e-9, 0, best));
          CHECK(std::abs(best[0].distance - room) <= 1e-12);
          const MotionBracket sinks = floor.firstContact(q0, below, {0, 1e-6});
          CHECK(sinks.verdict == MotionVerdict::contact);
          CHECK(std::abs(sinks.until - 0.5) <= 1e-6 + 1e-15 / room);
        }
      // It is free at the middle and in contact at the end.
      CHECK_FALSE(floor.isMotionFree(Eigen::Vector3d(-0.1, 0.031, 0), Eigen::Vector3d(0.1, 0.0295, 0)));
    }
  }
}

TEST_CASE("a motion that begins without approaching meets what its acceleration brings it to") {
  // A ball on a lever of 1 m begins opposite a ball or a mesh that stands on its circle. It approaches at 0
  // m/s first: only the bound on its acceleration limits the first step.
  Scene scene;
  const LoadedRobot lever = parsed(
      "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"><collision><geometry><sphere radius=\"0.01\"/>"
      "</geometry></collision></link><joint name=\"j\" type=\"revolute\"><parent link=\"a\"/>"
      "<child link=\"l\"/><axis xyz=\"0 0 1\"/><limit lower=\"-7\" upper=\"7\" effort=\"1\" velocity=\"1\"/>"
      "</joint><link name=\"l\"/><joint name=\"f\" type=\"fixed\"><parent link=\"l\"/><child link=\"b\"/>"
      "<origin xyz=\"1 0 0\"/></joint></robot>");
  scene.model = lever.model;
  scene.geometry = std::make_shared<const RobotGeometry>(lever.geometry);
  scene.kinematics = std::make_shared<const Kinematics>(scene.model);
  const auto across = pose(Eigen::Matrix3d::Identity(), {-1, 0, 0});
  for (const std::shared_ptr<fcl::CollisionGeometryd>& shape :
       {std::shared_ptr<fcl::CollisionGeometryd>(std::make_shared<fcl::Sphered>(0.01)),
        std::shared_ptr<fcl::CollisionGeometryd>(meshOfBox(0.02, 0.02, 0.02))}) {
    scene.obstacles = {obstacleOf(fcl::CollisionObjectd(shape, across), "there")};
    scene.pairs = obstaclePairs(*scene.model, *scene.geometry, 1, true);
    REQUIRE(scene.pairs.size() == 1);
    MotionCheck check(scene.kinematics, scene.geometry, scene.pairs, scene.obstacles);
    for (const double end : {3.5, 4.0, 4.5, 5.0, 6.0}) {
      CAPTURE(end);
      const VectorXd q0 = VectorXd::Zero(1), q1 = VectorXd::Constant(1, end);
      const MotionBracket found = check.firstContact(q0, q1, {0.0, 1e-6});
      CHECK(found.verdict == MotionVerdict::contact);
      // The surfaces, 20 mm apart between centres or less, meet a little before half a turn.
      CHECK(std::abs(found.until * end - M_PI) <= 0.03);
      CHECK_FALSE(check.isMotionFree(q0, q1));
    }
  }
}

TEST_CASE("two surfaces that pass through each other have no depth to be searched for") {
  const Scene scene = everyJoint(BaseMotion::fixed);
  std::vector<CheckedPair> surfaces;
  for (const CheckedPair& pair : scene.pairs)
    if (pair.obstacle && pair.other == 0 &&
        scene.geometry->bodies[static_cast<std::size_t>(pair.body)].geometry->getObjectType() == fcl::OT_BVH)
      surfaces.push_back(pair);
  REQUIRE(surfaces.size() == 1);
  MotionCheck check(scene.kinematics, scene.geometry, surfaces, scene.obstacles);
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    const VectorXd q0 = randomConfiguration(*scene.kinematics, random),
                   q1 = q0 + 2 * randomDirection(q0.size(), random);
    const MotionBracket found = check.firstContact(q0, q1, {-1e-9, 1e-4});
    CHECK(found.verdict == MotionVerdict::free);
    CHECK(found.queries < 10);
  }
}

TEST_CASE("a motion that is not finite is not free, and pairs that do not exist are refused") {
  const Scene scene = everyJoint(BaseMotion::fixed);
  MotionCheck check(scene.kinematics, scene.geometry, scene.pairs, scene.obstacles);
  const VectorXd q = VectorXd::Zero(scene.kinematics->size());
  VectorXd bad = q;
  bad[1] = std::nan("");
  CHECK_FALSE(check.isFree(bad));
  CHECK_FALSE(check.isMotionFree(q, bad));
  CHECK(check.firstContact(bad, q).verdict == MotionVerdict::undecided);
  CHECK_FALSE(check.isMotionFree(q, VectorXd::Zero(1)));
  CHECK_THROWS_AS(check.answer(-1, q), Error);
  CHECK_THROWS_AS(check.answer(static_cast<int>(scene.pairs.size()), q), Error);
  // A motion without checked pairs is not free.
  CHECK_THROWS_WITH(MotionCheck(scene.kinematics, scene.geometry, {}),
                    Catch::StartsWith("MotionCheck: no pairs are given"));
  CHECK_THROWS_AS(MotionCheck(scene.kinematics, scene.geometry, {{0, 99, false}}), Error);
  CHECK_THROWS_AS(MotionCheck(scene.kinematics, scene.geometry, {{0, 3, true}}, scene.obstacles), Error);
}

TEST_CASE("what rounding may add holds for a robot that comes from far away") {
  const Scene scene = everyJoint(BaseMotion::floating);
  MotionChains chains(*scene.kinematics, *scene.geometry, scene.obstacles, scene.pairs);
  VectorXd q0 = VectorXd::Zero(scene.kinematics->size()), q1 = q0;
  q0[0] = -1e6;
  q1[0] = 1e6;
  REQUIRE(chains.begin(q0, q1));
  chains.place(0.5);  // at the origin
  // q(t) is a sum of numbers of 1e6, which is rounded twice.
  CHECK(chains.slack() >= 2 * 1e6 * std::numeric_limits<double>::epsilon());
}

TEST_CASE("a half space that a link carries is not proven free of what it turns into") {
  const std::string ball = "<collision><geometry><sphere radius=\"0.1\"/></geometry></collision></link>";
  const auto carried = [&](const std::string& type) {
    Scene scene;
    scene.model = std::make_shared<const RobotModel>(
        parseUrdf("<robot name=\"r\"><link name=\"a\">" + ball + "<link name=\"b\">" + ball +
                      "<joint name=\"j\" type=\"" + type +
                      "\"><parent link=\"a\"/><child link=\"b\"/><origin xyz=\"1 0 0\"/><axis xyz=\"0 0 1\"/>"
                      "<limit lower=\"-3\" upper=\"3\" effort=\"1\" velocity=\"1\"/></joint></robot>",
                  "half_space.urdf"));
    RobotGeometry geometry = loadGeometry(*scene.model);
    const Eigen::Vector3d up = type == "revolute" ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
    geometry.bodies[1].geometry = std::make_shared<fcl::Halfspaced>(up, -0.3);
    geometry.bodies[1].centre.setConstant(std::numeric_limits<double>::quiet_NaN());
    geometry.bodies[1].radius = std::numeric_limits<double>::infinity();
    scene.geometry = std::make_shared<const RobotGeometry>(std::move(geometry));
    scene.kinematics = std::make_shared<const Kinematics>(scene.model);
    return MotionCheck(scene.kinematics, scene.geometry, {{0, 1, false}});
  };
  const VectorXd zero = VectorXd::Zero(1);
  MotionCheck turning = carried("revolute");
  CHECK(turning.isFree(zero));
  for (const double angle : {-0.25, -1.0, -3.0}) {  // at 0.2 rad it meets the ball, at 3 rad it is past it
    const MotionBracket first = turning.firstContact(zero, VectorXd::Constant(1, angle));
    CHECK(first.verdict != MotionVerdict::free);
    CHECK(first.from <= 0.21 / -angle);
  }
  MotionCheck sliding = carried("prismatic");
  CHECK(sliding.isMotionFree(zero, VectorXd::Constant(1, 0.199)));
  const MotionBracket first = sliding.firstContact(zero, VectorXd::Constant(1, 0.4));
  CHECK(first.verdict == MotionVerdict::contact);
  CHECK(first.until == Approx(0.5).margin(1e-4));
}
