// Numbers that are NaN, infinite or out of range: queries treat them as the worst case, options are refused
// by name. One section for each place where they can occur.
#include <fcl/geometry/shape/box.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/parts/convex_parts.h"
#include "fcl_stpbv/robot/pair_list.h"
#include "fcl_stpbv/robot/velocity_damper.h"
#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/stp_bv.h"
#include "fcl_stpbv/volume/tessellate.h"
#include "test/reference/robots.h"
#include "test/reference/shapes.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(),
                 kInf = std::numeric_limits<double>::infinity();
const double kNoNumbers[] = {kNaN, kInf, -kInf};

/// Two bodies on a hinge, and a third one behind it.
struct SmallRobot {
  std::shared_ptr<const RobotModel> model = std::make_shared<const RobotModel>(
      parseUrdf(robot(link("a", "<sphere radius=\"0.1\"/>") + link("b", "<sphere radius=\"0.1\"/>") +
                      link("c", "<box size=\"0.1 0.2 0.3\"/>") +
                      joint("j", "revolute", "a", "b", "<origin xyz=\"1 0 0\"/><axis xyz=\"0 0 1\"/>") +
                      joint("k", "revolute", "b", "c", "<origin xyz=\"1 0 0\"/><axis xyz=\"0 1 0\"/>")),
                "small.urdf"));
  std::shared_ptr<const Kinematics> kinematics = std::make_shared<const Kinematics>(model);
  std::shared_ptr<const RobotGeometry> geometry = std::make_shared<const RobotGeometry>(loadGeometry(*model));
  std::vector<CheckedPair> pairs = selfPairs(*model, *geometry, nullptr);
};

}  // namespace

TEST_CASE(
    "A volume asked with a direction or a point that is not finite answers with the worst, not with NaN") {
  const StpBv::Ptr volume = StpBv::build(box(0.2, 0.3, 0.5), {0.01, 10});
  const StpBvGeometry geometry(volume);
  for (const double bad : kNoNumbers)
    for (int axis = 0; axis < 3; ++axis) {
      Vector3d v(0.6, 0, 0.8);
      v[axis] = bad;
      CHECK(volume->support(v) == kInf);
      CHECK(volume->surfacePoint(v).allFinite());
      CHECK(signedDistance(*volume, v) == -kInf);
      CHECK(contains(*volume, v));
      const Distance d = distance(geometry, Eigen::Isometry3d::Identity(), v);
      CHECK(d.status == DistanceStatus::invalid);
      CHECK_FALSE(std::isnan(d.distance));
    }
}

TEST_CASE("No pair is farther than a distance that is no number") {
  const StpBvGeometry a(StpBv::build(box(0.2, 0.3, 0.5), {0.01, 10}));
  const fcl::Boxd b(0.1, 0.1, 0.1), c(0.2, 0.2, 0.2);
  const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();
  const Eigen::Isometry3d there = pose(Eigen::Matrix3d::Identity(), {5, 0, 0});
  CHECK(isFartherThan(1, a, here, b, there));
  CHECK_FALSE(isFartherThan(kNaN, a, here, b, there));
  CHECK_FALSE(isFartherThan(kNaN, c, here, b, there));
  CHECK_FALSE(isFartherThan(kInf, a, here, b, there));
  CHECK(collides(a, here, b, there, kNaN));
}

TEST_CASE("A pair that cannot be measured at a huge but finite configuration does not read as clear") {
  const SmallRobot small;
  const auto floating = std::make_shared<const Kinematics>(small.model, BaseMotion::floating);
  CollisionConstraints constraints(floating, small.geometry, small.pairs);
  Eigen::VectorXd q = floating->neutral(), d(constraints.rows());
  q[0] = 1e160;
  CHECK(constraints.evaluate(q, d));
  RowRates rates = constraints.makeRates();
  Eigen::VectorXd values(constraints.nonZeros());
  CHECK(constraints.evaluateValues(q, Eigen::VectorXd::Ones(q.size()), rates, values));
  for (int row = 0; row < constraints.rows(); ++row) {
    CHECK(constraints.answer(row).status == DistanceStatus::invalid);
    CHECK(d[row] == std::numeric_limits<double>::lowest());
    CHECK(constraints.gradientRateBound(row) == kInf);
  }
}

TEST_CASE("Options that are not finite or out of range are refused by name") {
  const Cloud cloud = box(0.2, 0.3, 0.5);
  const StpBv::Ptr volume = StpBv::build(cloud, {0.01, 10});
  const TriangleMesh mesh = tessellate(*volume, 0.5);
  const SmallRobot small;
  CollisionConstraints constraints(small.kinematics, small.geometry, small.pairs);
  for (const double bad : {kNaN, kInf, -kInf, -1.0}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(StpBv::build(cloud, {bad, 10}), Error);
    CHECK_THROWS_AS(StpBv::build(cloud, {0.01, bad}), Error);
    CHECK_THROWS_AS(StpBv::smallestR(cloud, bad), Error);
    // An infinite budget allows any over-cover.
    if (bad != kInf) CHECK_THROWS_AS(reduce(cloud, {0.01, 10}, bad), Error);
    CHECK_THROWS_WITH(tessellate(*volume, bad), Catch::Contains("angle"));
    PartsOptions parts;
    parts.excess = bad;
    CHECK_THROWS_WITH(convexParts(mesh, parts), Catch::Contains("excess"));
    parts = {};
    parts.effort = bad;
    CHECK_THROWS_WITH(convexParts(mesh, parts), Catch::Contains("effort"));
    GeometryOptions geometry;
    geometry.radii.r = bad;
    CHECK_THROWS_WITH(loadGeometry(*small.model, geometry), Catch::Contains("small.urdf: r: got"));
    geometry = {};
    geometry.links["b"] = {0.01, bad};
    CHECK_THROWS_WITH(loadGeometry(*small.model, geometry), Catch::Contains("R of link 'b': got"));
    geometry = {};
    geometry.overCoverBudget = bad;
    CHECK_THROWS_WITH(loadGeometry(*small.model, geometry), Catch::Contains("over-cover: got"));
    ConstraintOptions influence;
    influence.influence = bad;
    if (bad != kInf)  // inf is the default
      CHECK_THROWS_AS(CollisionConstraints(small.kinematics, small.geometry, small.pairs, influence), Error);
    DamperOptions damper;
    damper.period = bad;
    CHECK_THROWS_WITH(VelocityDamper(constraints, damper), Catch::Contains("period"));
    damper = {};
    damper.all.damping = bad;
    CHECK_THROWS_WITH(VelocityDamper(constraints, damper), Catch::Contains("damping"));
    damper = {};
    damper.all.influence = bad;
    CHECK_THROWS_WITH(VelocityDamper(constraints, damper), Catch::Contains("influence"));
    PairListOptions pairs;
    pairs.alwaysFraction = bad;
    CHECK_THROWS_WITH(pairList(small.kinematics, small.geometry, nullptr, pairs),
                      Catch::Contains("alwaysFraction"));
    pairs = {};
    pairs.proofSeconds = bad;
    CHECK_THROWS_WITH(pairList(small.kinematics, small.geometry, nullptr, pairs),
                      Catch::Contains("proofSeconds"));
  }
  ConstraintOptions exact;
  exact.exactUpTo = kNaN;
  CHECK_THROWS_AS(CollisionConstraints(small.kinematics, small.geometry, small.pairs, exact), Error);
  exact.exactUpTo = exact.influence = 0.1;  // a kink
  CHECK_THROWS_WITH(CollisionConstraints(small.kinematics, small.geometry, small.pairs, exact),
                    Catch::Contains("exactUpTo must be less than influence"));
  exact.influence = kInf;
  for (const double handOver : {kInf, 0.2}) {
    exact.handOver = handOver;
    CHECK_THROWS_WITH(CollisionConstraints(small.kinematics, small.geometry, small.pairs, exact),
                      Catch::Contains("exactUpTo needs an influence"));
  }
  DamperOptions headroom;
  headroom.headroom = kNaN;
  CHECK_THROWS_WITH(VelocityDamper(constraints, headroom), Catch::Contains("headroom"));
  PairListOptions pairs;
  pairs.margin = kNaN;
  CHECK_THROWS_WITH(pairList(small.kinematics, small.geometry, nullptr, pairs), Catch::Contains("margin"));
  pairs = {};
  pairs.neutral = Eigen::VectorXd::Constant(2, kNaN);
  CHECK_THROWS_WITH(pairList(small.kinematics, small.geometry, nullptr, pairs), Catch::Contains("neutral"));
  pairs.neutral = Eigen::VectorXd::Zero(1);
  CHECK_THROWS_WITH(pairList(small.kinematics, small.geometry, nullptr, pairs), Catch::Contains("neutral"));
}

TEST_CASE("Rows, rates and Hessians at numbers that are not finite say so and hold no NaN") {
  const SmallRobot small;
  CollisionConstraints constraints(small.kinematics, small.geometry, small.pairs);
  REQUIRE(constraints.rows() > 0);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(constraints.columns()),
                        ones = Eigen::VectorXd::Ones(constraints.rows());
  Eigen::VectorXd d(constraints.rows()), out(constraints.columns());
  Eigen::MatrixXd full(constraints.columns(), constraints.columns());
  CollisionConstraints::SparseHessian lower = constraints.makeHessian();
  REQUIRE(constraints.hessianVector(zero, ones, zero, out));
  REQUIRE(constraints.hessian(zero, ones, lower));
  REQUIRE(constraints.hessian(zero, 0, full));
  for (const double bad : kNoNumbers) {
    Eigen::VectorXd q = zero, weights = ones;
    q[1] = weights[0] = bad;
    CHECK_FALSE(constraints.evaluate(q, d));
    CHECK(d.maxCoeff() == std::numeric_limits<double>::lowest());
    CHECK_FALSE(constraints.hessianVector(q, ones, zero, out));
    CHECK_FALSE(constraints.hessianVector(zero, weights, zero, out));
    CHECK_FALSE(constraints.hessianVector(zero, ones, q, out));
    CHECK(out.isZero(0));
    CHECK_FALSE(constraints.hessian(q, ones, lower));
    CHECK_FALSE(constraints.hessian(zero, weights, lower));
    CHECK(lower.norm() == 0);
    CHECK_FALSE(constraints.hessian(q, 0, full));
    CHECK(full.isZero(0));
  }
}
