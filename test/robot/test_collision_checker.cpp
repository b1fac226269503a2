// Verdicts of CollisionChecker, compared with the exact distances of CollisionConstraints; also
// configurations that must not be called clear.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/geometric_shape_to_BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/sphere.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <memory>

#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/collision_checker.h"
#include "fcl_stpbv/robot/constraints.h"
#include "fcl_stpbv/robot/motion_check.h"
#include "test/reference/random_walk.h"
#include "test/reference/robots.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::VectorXd;

namespace {

constexpr double kLowest = std::numeric_limits<double>::lowest();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A robot, with obstacles of every kind around it.
struct Scene {
  Problem robot;
  std::vector<Obstacle> obstacles;
};

Scene sceneOf(const TestRobot& robot, BaseMotion base, bool obstacles) {
  Scene scene{problem(robot, base), {}};
  if (!obstacles) return scene;
  // The rotations have the rounding of single precision.
  const Eigen::Matrix3d turn = Random(3).rotation().cast<float>().cast<double>();
  const auto add = [&](std::shared_ptr<fcl::CollisionGeometryd> geometry, const Eigen::Vector3d& where) {
    const fcl::CollisionObjectd object(geometry, pose(turn, where));
    scene.obstacles.push_back(obstacleOf(object, "obstacle"));
  };
  auto mesh = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  fcl::generateBVHModel(*mesh, fcl::Sphered(0.2), Eigen::Isometry3d::Identity(), 8, 8);
  add(mesh, {0.7, 0.3, 0.3});
  add(std::make_shared<fcl::Boxd>(0.2, 0.3, 0.4), {0.5, -0.4, 0.2});
  add(std::make_shared<StpBvGeometry>(StpBv::build(box(0.3, 0.2, 0.1))), {-0.5, 0.1, 0.1});
  add(std::make_shared<fcl::Halfspaced>(turn.transpose() * Eigen::Vector3d(0, 0, 1), -1.2), {0, 0, 0});
  const Problem& p = scene.robot;
  const std::vector<CheckedPair> around =
      obstaclePairs(*p.model, *p.geometry, scene.obstacles.size(), base != BaseMotion::fixed);
  scene.robot.pairs.insert(scene.robot.pairs.end(), around.begin(), around.end());
  return scene;
}

/// Compares the verdicts on one configuration with the distances' certified bounds.
class Judge {
 public:
  Judge(const Scene& scene, double margin)
      : margin_(margin),
        rows_(scene.robot.kinematics, scene.robot.geometry, scene.robot.pairs, optionsOf(scene)),
        d_(rows_.rows()),
        checker_(scene.robot.kinematics, scene.robot.geometry, scene.robot.pairs, scene.obstacles, margin) {}

  CollisionChecker& checker() { return checker_; }
  int hits() const { return hits_; }
  int clear() const { return clear_; }

  /// Compares the verdicts at q. @returns the least distance.
  double look(const VectorXd& q) {
    rows_.evaluate(q, d_);
    std::vector<bool> isHit(static_cast<std::size_t>(rows_.rows()));
    for (const Hit& hit : checker_.allHits(q)) isHit[static_cast<std::size_t>(hit.pair)] = true;
    bool surelyHit = false, surelyClear = true;
    for (int row = 0; row < rows_.rows(); ++row) {
      const DistanceAnswer answer = rows_.answer(row);
      // Twice the rounding of a pair: the bounds of the verdict may differ from the answer's by that.
      const double rounding = 1e-12;
      const bool hit = isHit[static_cast<std::size_t>(row)];
      CAPTURE(row, rows_.name(row), d_[row], answer.lower, answer.upper, hit);
      if (answer.lower > margin_ + rounding) CHECK_FALSE(hit);
      if (answer.upper <= margin_ - rounding) {
        CHECK(hit);
        surelyHit = true;
      }
      surelyClear = surelyClear && answer.lower > margin_ + rounding;
    }
    const std::optional<Hit> first = checker_.firstHit(q);
    if (surelyHit) CHECK(first);
    if (surelyClear) CHECK_FALSE(first);
    if (first) {
      REQUIRE(first->pair >= 0);
      CHECK(rows_.answer(first->pair).lower <= margin_ + 1e-12);
      CHECK(first->bodies.body == checker_.pairs()[static_cast<std::size_t>(first->pair)].body);
    }
    CHECK(checker_.collides(q) == first.has_value());
    ++(first ? hits_ : clear_);
    return d_.minCoeff();
  }

  /// Compares minDistance() with the least of all rows, if that is exact.
  void lookAtLeast(const VectorXd& q) {
    const double least = checker_.minDistance(q);
    rows_.evaluate(q, d_);
    Eigen::Index row;
    const double expected = d_.minCoeff(&row);
    CAPTURE(least, expected, rows_.name(static_cast<int>(row)));
    const DistanceAnswer answer = rows_.answer(static_cast<int>(row));
    if (answer.status == DistanceStatus::exact)
      CHECK(least == Approx(expected).margin(1e-12));  // both are exact, found from different starts
    else
      CHECK((least >= answer.lower - 1e-12 && least <= answer.upper + 1e-12));
  }

 private:
  static ConstraintOptions optionsOf(const Scene& scene) {
    ConstraintOptions options;
    options.obstacles = scene.obstacles;
    return options;
  }

  double margin_;
  CollisionConstraints rows_;
  VectorXd d_;
  CollisionChecker checker_;
  int hits_ = 0, clear_ = 0;
};

/// A configuration on the line between a clear and a colliding one where the verdict changes, to 40 halvings.
VectorXd nearContact(CollisionChecker& checker, VectorXd clear, VectorXd hit) {
  for (int i = 0; i < 40; ++i) {
    const VectorXd middle = 0.5 * (clear + hit);
    (checker.collides(middle) ? hit : clear) = middle;
  }
  return clear;
}

}  // namespace

TEST_CASE("verdicts on random configurations and small steps are those of the certified distances") {
  Random random(11);
  for (const TestRobot& robot : robots())
    for (const bool obstacles : {false, true}) {
      const Scene scene = sceneOf(robot, obstacles ? BaseMotion::floating : BaseMotion::fixed, obstacles);
      for (const double margin : {0.0, 0.03, -0.015}) {
        CAPTURE(robot.name, obstacles, margin);
        Judge judge(scene, margin);
        const Kinematics& kinematics = judge.checker().kinematics();
        for (int start = 0; start < 12; ++start) {
          VectorXd q = start == 0 ? kinematics.neutral() : randomConfiguration(kinematics, random);
          for (int step = 0; step < 8; ++step) {
            judge.look(q);
            judge.lookAtLeast(q);
            q += (step % 4 == 3 ? 0.3 : 0.02) * randomDirection(q.size(), random);
          }
        }
        CHECK(judge.hits() > 0);
        CHECK(judge.clear() + judge.hits() == 96);
      }
    }
}

TEST_CASE("next to contact, to the last bits of q, verdicts keep to the certified distances") {
  Random random(12);
  const Scene scene = sceneOf(robots()[0], BaseMotion::floating, true);
  for (const double margin : {0.0, 0.02}) {
    Judge judge(scene, margin);
    int looked = 0;
    for (int i = 0; i < 40; ++i) {
      const VectorXd a = randomConfiguration(*scene.robot.kinematics, random),
                     b = randomConfiguration(*scene.robot.kinematics, random);
      const bool hitA = judge.checker().collides(a), hitB = judge.checker().collides(b);
      if (hitA == hitB) continue;
      const VectorXd q = nearContact(judge.checker(), hitA ? b : a, hitA ? a : b);
      for (const double step : {0.0, 1e-12, -1e-12, 1e-9, -1e-9, 1e-6, -1e-6}) {
        const double least = judge.look(q + step * (b - a));
        CHECK(std::abs(least - margin) < 1e-4);  // it is close to contact
        ++looked;
      }
    }
    CHECK(looked > 50);
    CHECK((judge.hits() > 10 && judge.clear() > 10));
  }
}

TEST_CASE("an invalid configuration is never clear") {
  const Problem p = problem(robots()[0], BaseMotion::floating);
  CollisionChecker checker(p.kinematics, p.geometry, p.pairs);
  const VectorXd q = p.kinematics->configuration(loadSrdf(robots()[0].srdf, *p.model).state("half_sitting"));
  REQUIRE_FALSE(checker.collides(q));
  for (const double wrong : {std::nan(""), kInfinity, -kInfinity, 1e160})
    for (const int k : {0, 3, 20}) {
      VectorXd other = q;
      other[k] = wrong;
      CAPTURE(wrong, k);
      const bool turns = k == 20 && std::isfinite(wrong);  // a joint may turn by any angle
      CHECK((turns || checker.collides(other)));
      if (!other.allFinite()) {
        REQUIRE(checker.firstHit(other));
        CHECK(checker.firstHit(other)->pair == -1);
        if (const auto hit = checker.firstHit(other))  // as docs/robot.md has it
          CHECK(checker.name(hit->pair) == "(q is not a valid configuration)");
        CHECK(checker.allHits(other).size() == 1);
      }
      CHECK((turns || checker.minDistance(other) == kLowest));
    }
  CHECK(checker.collides(VectorXd::Zero(q.size() - 1)));
  CHECK(checker.minDistance(VectorXd::Zero(q.size() + 1)) == kLowest);
  CHECK_FALSE(checker.collides(q));
}

TEST_CASE("the verdict does not depend on what was asked before, nor a copy on its original") {
  const Problem p = problem(robots()[0]);
  CollisionChecker walked(p.kinematics, p.geometry, p.pairs, {}, 0.01);
  Random random(13);
  for (int i = 0; i < 200; ++i) {
    const VectorXd q = randomConfiguration(*p.kinematics, random);
    CollisionChecker fresh(p.kinematics, p.geometry, p.pairs, {}, 0.01);
    const bool hit = fresh.collides(q);
    CHECK(walked.collides(q) == hit);
    CollisionChecker copy = walked;
    CHECK(copy.collides(q) == hit);
    walked.setMargin(0.5);
    CHECK(walked.collides(q));
    walked.setMargin(0.01);
  }
}

TEST_CASE(
    "a checker without pairs, with a pair that does not exist, or with a margin that is not a number is "
    "refused") {
  const Problem p = problem(robots()[0]);
  CHECK_THROWS_AS(CollisionChecker(p.kinematics, p.geometry, {}), Error);
  CHECK_THROWS_AS(CollisionChecker(p.kinematics, p.geometry, {{0, 1000}}), Error);
  CHECK_THROWS_AS(CollisionChecker(p.kinematics, p.geometry, {{0, 0, true}}), Error);
  CHECK_THROWS_AS(CollisionChecker(p.kinematics, p.geometry, p.pairs, {}, std::nan("")), Error);
  CollisionChecker checker(p.kinematics, p.geometry, p.pairs);
  CHECK_THROWS_AS(checker.setMargin(std::nan("")), Error);
  CHECK(checker.name(0).find(" - ") != std::string::npos);
  for (const int pair : {-2, static_cast<int>(checker.pairs().size())})
    CHECK_THROWS_WITH(checker.name(pair), Catch::Contains("no pair " + std::to_string(pair)));
}

TEST_CASE("small steps search for few pairs, random configurations for those near each other") {
  const Problem p = problem(robots()[0]);
  const auto walk = [&](double step) {
    CollisionChecker checker(p.kinematics, p.geometry, p.pairs);
    const Eigen::MatrixXd q = randomWalk(*p.kinematics, step, 2000);
    for (Eigen::Index i = 0; i < q.cols(); ++i) checker.allHits(q.col(i));
    return checker.work();
  };
  const auto per = [](long count, const CheckerWork& work) {
    return static_cast<double>(count) / static_cast<double>(work.configurations);
  };
  const CheckerWork small = walk(kSmallStep), large = walk(kRandomStep);
  CAPTURE(per(small.near, small), per(small.searched, small), per(large.near, large),
          per(large.searched, large));
  // Measured when this was written, plus a tenth.
  CHECK(per(small.near, small) < 16.7);
  CHECK(per(small.searched, small) < 0.032);
  CHECK(per(large.near, large) < 8.7);
  CHECK(per(large.searched, large) < 8.3);
}

TEST_CASE("a body in the middle of a room's mesh, or in the box around a hull, is not in collision") {
  const std::string ball =
      "<robot name='r'><link name='a'/><link name='b'><collision><geometry><sphere radius='0.1'/></geometry>"
      "</collision></link><joint name='j' type='prismatic'><parent link='a'/><child link='b'/><axis xyz='1 1 "
      "1'/>"
      "<limit lower='-1' upper='1' effort='1' velocity='1'/></joint></robot>";
  const auto model = std::make_shared<const RobotModel>(parseUrdf(ball, "ball"));
  const auto kinematics = std::make_shared<const Kinematics>(model);
  const auto geometry = std::make_shared<const RobotGeometry>(loadGeometry(*model, {}));
  auto room = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  fcl::generateBVHModel(*room, fcl::Boxd(6, 6, 6), Eigen::Isometry3d::Identity());
  room->computeLocalAABB();
  // The middle of this tetrahedron's box is outside of it, sqrt(3) / 6 from the slanted face.
  const std::vector<Eigen::Vector3d> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  struct Case {
    std::shared_ptr<fcl::CollisionGeometryd> geometry;
    double q, distance;  // of the ball, which is this far along (1, 1, 1)
  };
  for (const Case& c :
       {Case{room, 0, 2.9}, Case{detail::hullGeometry(corners), std::sqrt(0.75), std::sqrt(3.0) / 6 - 0.1}}) {
    const std::vector<Obstacle> obstacles{
        obstacleOf(fcl::CollisionObjectd(c.geometry, Eigen::Isometry3d::Identity()), "obstacle")};
    CollisionChecker checker(kinematics, geometry, {{0, 0, true}}, obstacles);
    const VectorXd q = VectorXd::Constant(1, c.q);
    CHECK(checker.minDistance(q) == Approx(c.distance).margin(1e-12));  // rounding of coordinates below 6 m
    for (const double off : {-1e-9, 1e-9}) {
      checker.setMargin(c.distance + off);
      CHECK(checker.collides(q) == (off > 0));
    }
  }
  // A centre inside its hull still gives a verdict without a search.
  const std::vector<Obstacle> around{obstacleOf(
      fcl::CollisionObjectd(detail::hullGeometry(box(1, 1, 1)), Eigen::Isometry3d::Identity()), "hull")};
  CollisionChecker checker(kinematics, geometry, {{0, 0, true}}, around);
  CHECK(checker.collides(VectorXd::Zero(1)));
  CHECK(checker.work().searched == 0);
}

TEST_CASE("an obstacle of a geometry and a pose alone stops a robot that is inside it") {
  const Problem p = problem(robots()[0], BaseMotion::floating);
  const std::vector<CheckedPair> pairs = obstaclePairs(*p.model, *p.geometry, 1, true);
  const auto mesh = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();  // FCL has not computed its box
  fcl::generateBVHModel(*mesh, fcl::Boxd(4, 4, 4), Eigen::Isometry3d::Identity());
  const std::vector<std::shared_ptr<const fcl::CollisionGeometryd>> large{
      std::make_shared<fcl::Sphered>(3), std::make_shared<fcl::Boxd>(6, 6, 6),
      std::make_shared<StpBvGeometry>(StpBv::build(box(3, 3, 3))), detail::hullGeometry(box(3, 3, 3)),
      std::make_shared<fcl::Halfspaced>(Eigen::Vector3d(0, 0, 1), 3)};
  const VectorXd q = p.kinematics->neutral();
  for (const auto& geometry : large) {
    CollisionChecker checker(p.kinematics, p.geometry, pairs, {{"around", geometry}});
    CHECK(checker.collides(q));
    CHECK(checker.minDistance(q) < -1);
    ConstraintOptions options;
    options.obstacles = {{"around", geometry}};
    CollisionConstraints constraints(p.kinematics, p.geometry, pairs, options);
    VectorXd d(constraints.rows());
    constraints.evaluate(q, d);
    CHECK(d.minCoeff() < -1);
    CHECK_FALSE(MotionCheck(p.kinematics, p.geometry, pairs, options.obstacles).isMotionFree(q, q));
  }
  // The wall of a mesh without a box goes through the robot: x = 0 is in every body of the neutral posture.
  CollisionChecker checker(p.kinematics, p.geometry, pairs,
                           {{"wall", mesh, pose(Eigen::Matrix3d::Identity(), {2, 0, 0})}});
  CHECK(checker.collides(q));

  // At a pose that is no rotation nothing is clear, however far away.
  Eigen::Isometry3d twice = pose(Eigen::Matrix3d::Identity(), {50, 0, 0});
  twice.linear() *= 2;
  for (const auto& geometry : large) {
    Obstacle obstacle("far", geometry, twice);
    CHECK(CollisionChecker(p.kinematics, p.geometry, pairs, {obstacle}).collides(q));
    if (std::dynamic_pointer_cast<const fcl::Halfspaced>(geometry)) continue;
    obstacle.place(pose(Eigen::Matrix3d::Identity(), {50, 0, 0}));
    CHECK_FALSE(CollisionChecker(p.kinematics, p.geometry, pairs, {obstacle}).collides(q));
  }
  CHECK_THROWS_WITH(Obstacle("crate", nullptr), "obstacle 'crate': its geometry is null");
}

TEST_CASE("a body without a bounding sphere is never left out as far away") {
  const Problem p = problem(robots()[0]);
  RobotGeometry bare = *p.geometry;
  for (Body& body : bare.bodies) {
    const Body blank;
    body.centre = blank.centre, body.radius = blank.radius;
  }
  const auto geometry = std::make_shared<const RobotGeometry>(bare);
  CollisionChecker checker(p.kinematics, geometry, p.pairs), known(p.kinematics, p.geometry, p.pairs);
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const VectorXd q = randomConfiguration(*p.kinematics, random);
    CHECK(checker.collides(q) == known.collides(q));
  }
}
