// What rounding may make of a proof: no bound is above the distance of exact arithmetic, and a box that only
// rounding leaves open is not cut for ever.
#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/robot/pair_proof.h"
#include "fcl_stpbv/robot/pair_search.h"
#include "test/reference/shapes.h"
#include "test/robot/bound_trials.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;

namespace {

const std::string kTenthBall = "<sphere radius=\"0.1\"/>";

JointBox pointAt(const Eigen::VectorXd& q) { return {q, q}; }

std::string decimal(double x) { return std::to_string(x); }

}  // namespace

TEST_CASE("no bound is above a distance where fixed links lead far away and back") {
  for (const double far : {1e2, 1e4, 1e5}) {
    const ProofScene scene = proofSceneOf(
        robot(link("o", kTenthBall) + link("a") + link("b") + link("back") + link("c", kTenthBall) +
              joint("j1", "revolute", "o", "a", "<axis xyz=\"0 0 1\"/>", 3) +
              joint("out", "fixed", "a", "b", "<origin xyz=\"" + decimal(far) + " 0.25 0\"/>") +
              joint("home", "fixed", "b", "back", "<origin xyz=\"" + decimal(0.5 - far) + " 0 0\"/>") +
              joint("j2", "revolute", "back", "c", "<axis xyz=\"0 0 1\"/>", 3)));
    const LinkPair pair{0, 4};
    const long double truth = std::sqrt(0.5L * 0.5L + 0.25L * 0.25L) - 2 * static_cast<long double>(0.1);
    Random random(1);
    for (int i = 0; i < 400; ++i) {
      const Eigen::Vector2d q(random.uniform(-3, 3), random.uniform(-3, 3));
      const double bound = distanceBound(scene, pair, pointAt(q));
      CHECK(bound <= truth);
      CHECK(bound > truth - 1e-12L * far);  // the bound is close to the distance
    }
  }
}

TEST_CASE("no bound is above a distance where a sliding follower's offset cancels its product") {
  const double multiplier = 1e6, offset = -999999.5;
  const ProofScene scene = proofSceneOf(
      robot(link("base", kTenthBall) + link("leader") + link("s", kTenthBall) +
            joint("lead", "prismatic", "base", "leader", "<axis xyz=\"0 1 0\"/>") +
            joint("follow", "prismatic", "base", "s",
                  "<axis xyz=\"1 0 0\"/><mimic joint=\"lead\" multiplier=\"1e6\" offset=\"-999999.5\"/>")));
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const double q = 0.9999998 + random.uniform(0, 2e-7);
    const long double way = static_cast<long double>(multiplier) * q + offset;
    const long double truth = std::abs(way) - 2 * static_cast<long double>(0.1);
    const double bound = distanceBound(scene, {0, 2}, pointAt(Eigen::VectorXd::Constant(1, q)));
    CHECK(bound <= truth);
    CHECK(bound > truth - 1e-6L);
  }
}

TEST_CASE("a box that is not clear and cannot be cut stays open, and the others are examined") {
  ProofScene scene = proofSceneOf(robot(link("a", kTenthBall) + link("m") + link("b", kTenthBall) +
                                        joint("x", "prismatic", "a", "m", "<axis xyz=\"1 0 0\"/>") +
                                        joint("y", "prismatic", "m", "b", "<axis xyz=\"0 1 0\"/>")));
  const LinkPair pair{0, 2};
  PairSearch search(scene.kinematics, scene.geometry, pair);
  const Eigen::Vector2d near(0.5, 0.25), far(1, 1);
  // Above the margin, but by less than rounding.
  scene.margin = std::nextafter(search.distance(near), 0);
  const Eigen::Vector2d next(std::nextafter(0.5, 1), 0.25);
  for (const Eigen::Vector2d& upper : {near, next}) {  // no number lies between the ends of the second box
    const PairProof proof = provePair(scene, pair, {pointAt(far), JointBox{near, upper}, pointAt(far)}, 1000);
    CHECK(proof.boxes == 3);
    CHECK_FALSE(proof.collision);
    REQUIRE(proof.open.size() == 1);
    CHECK(proof.open[0].lower == near);
    const PairProof again = provePair(scene, pair, proof.open, 1000);
    CHECK(again.boxes == 1);
    CHECK(again.open.size() == 1);
  }
  // A collision found later ends the proof all the same.
  const PairProof hit = provePair(scene, pair, {pointAt(Eigen::Vector2d::Zero()), pointAt(near)}, 1000);
  CHECK(hit.collision);
  CHECK(hit.open.empty());
}
