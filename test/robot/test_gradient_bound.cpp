// The results of gradientRateBound() for bodies that overlap and for polyhedra.
#include <fcl/geometry/shape/box.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "test/reference/robots.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kDifferenceStep = 1e-6;

// A ball of radius `r` on an arm of 1 m sinks into `other`: the rail moves it sideways, the arm turns it.
struct Sunk {
  std::unique_ptr<CollisionConstraints> constraints;

  Sunk(const std::shared_ptr<fcl::CollisionGeometryd>& other, double r, double apart) {
    const char* const arm = R"(<robot name="arm"><link name="base"/><link name="m"/><link name="b"/>
      <joint name="turn" type="continuous"><parent link="base"/><child link="m"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/></joint>
      <joint name="rail" type="prismatic"><parent link="m"/><child link="b"/><origin xyz="-1 0 0"/><axis xyz="0 1 0"/>
        <limit lower="-9" upper="9" effort="1" velocity="1"/></joint></robot>)";
    const auto model = std::make_shared<const RobotModel>(parseUrdf(arm, "arm.urdf"));
    const Body ball = smoothBody(model->link("b"), "ball", StpBv::build({{0, 0, 0}}, {r, 2 * r}));
    constraints = singleRow(std::make_shared<const Kinematics>(model), ball,
                            fcl::CollisionObjectd(other, Eigen::Matrix3d::Identity(), {apart, 0, 0}));
  }
};

}  // namespace

TEST_CASE("a gradient's bound holds in any depth that it is given for") {
  const auto ballOf = [](double r) {
    return std::make_shared<StpBvGeometry>(StpBv::build({{0, 0, 0}}, {r, r + 1}));
  };
  Random random(3);
  double nearest = 0;
  const auto compare = [&](const std::shared_ptr<fcl::CollisionGeometryd>& other, double r, double d,
                           double apart) {
    const Sunk sunk(other, r, apart);
    CollisionConstraints& constraints = *sunk.constraints;
    RowRates rates = constraints.makeRates();
    MatrixXd jacobian(1, 2), before(1, 2), after(1, 2);
    VectorXd row(1);
    double most = 0;
    for (int trial = 0; trial < 20; ++trial) {
      const VectorXd qd = trial == 0 ? VectorXd::Unit(2, 1) : randomDirection(2, random);
      const VectorXd q = VectorXd::Zero(2);
      constraints.evaluate(q, qd, rates, jacobian);
      CHECK(std::abs(rates.d[0] - d) < 1e-12);
      const double bound = constraints.gradientRateBound(0);
      constraints.evaluate(q + kDifferenceStep * qd, row, after);
      constraints.evaluate(q - kDifferenceStep * qd, row, before);
      const double change = (after - before).norm() / (2 * kDifferenceStep);
      CAPTURE(r, d, qd, change, bound);
      // The gradient's rounding divided by the step, and the square of the step divided by that of the
      // radius.
      CHECK(change <= bound * (1 + 1e-6) + 1e-9);
      nearest = std::max(nearest, change / bound);
      most = std::max(most, bound);
    }
    return most;
  };
  // Two balls: from -0.1 on the depth exceeds the small radius, from -1 on also the large one.
  for (const double d : {0.1, 0.0, -0.05, -0.1, -0.3, -0.9, -0.99})
    CHECK(std::isfinite(compare(ballOf(0.1), 1, d, 1.1 + d)));
  for (const double d : {-0.05, -0.9}) CHECK(std::isfinite(compare(ballOf(1), 0.1, d, 1.1 + d)));
  CHECK(std::isinf(compare(ballOf(0.1), 1, -1.05, 0.05)));
  CHECK(std::isinf(compare(ballOf(0.5), 0.5, -0.6, 0.4)));
  for (const double d : {0.1, 0.0, -0.2, -0.4})
    CHECK(std::isfinite(compare(std::make_shared<fcl::Boxd>(2, 2, 2), 0.5, d, 1.5 + d)));
  CHECK(nearest > 0.5);  // otherwise the bound would be too wide to test anything
}

TEST_CASE("the gradient of two polyhedra has no bound, and none is not a number") {
  GeometryOptions flat;
  flat.flat = true;
  const LoadedRobot rail = parsed(robot(link("base") + link("b", "<box size=\"0.2 0.2 0.2\"/>") +
                                        joint("x", "prismatic", "base", "b", "", 9)),
                                  flat);
  const auto geometry = std::make_shared<RobotGeometry>(rail.geometry);
  ConstraintOptions options;
  options.influence = 2;
  const fcl::CollisionObjectd wall(std::make_shared<fcl::Boxd>(0.5, 0.4, 0.1), Random(7).rotation(),
                                   {3, 0, 0});
  options.obstacles = {obstacleOf(wall, "wall")};
  CollisionConstraints constraints(std::make_shared<const Kinematics>(rail.model), geometry, {{0, 0, true}},
                                   options);
  RowRates rates = constraints.makeRates();
  MatrixXd jacobian(1, 1);
  for (double x = -1; x < 2.5; x += 0.01)
    for (const double speed : {0.0, 1.0}) {
      constraints.evaluate(VectorXd::Constant(1, x), VectorXd::Constant(1, speed), rates, jacobian);
      const double bound = constraints.gradientRateBound(0);
      CAPTURE(x, speed, rates.d, bound);
      CHECK(bound == (rates.d[0] == 1.5 ? 0 : HUGE_VAL));  // the row is constant far away
    }
}
