// The results of evaluate(q, qd) for every row, and the Hessians of rows and of a Lagrangian, compared with
// central differences and with each other.
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>

#include <catch2/catch.hpp>

#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "test/reference/robots.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kStep = 1e-6;

/// All moving values of a row at one configuration.
struct Moving {
  VectorXd speed, where;  // speed of the row; its normal and both witness points
};
Moving at(CollisionConstraints& constraints, const VectorXd& q, const VectorXd& qd, RowRates& rates,
          MatrixXd& jacobian) {
  constraints.evaluate(q, qd, rates, jacobian);
  Moving m{rates.speed, VectorXd::Zero(9 * constraints.rows())};
  for (int row = 0; row < static_cast<int>(constraints.pairs().size()); ++row) {
    const RowAnswer a = constraints.answer(row);
    m.where.segment<9>(9 * row) << a.normal, a.points[0], a.points[1];
  }
  return m;
}

struct Found {
  double speed = 0, drift = 0, velocity = 0;
  int compared = 0, boundaries = 0;
};

// Rows whose one-sided differences show a region boundary in between are left out and counted. So are deep
// answers, which may jump.
Found compare(CollisionConstraints& constraints, const Kinematics& kinematics, int count) {
  Random random(23);
  Found found;
  RowRates here = constraints.makeRates(), other = here;
  MatrixXd jacobian(constraints.rows(), constraints.columns()), otherJacobian(jacobian);
  const int pairs = static_cast<int>(constraints.pairs().size());
  for (int trial = 0; trial < count; ++trial) {
    const VectorXd q = randomConfiguration(kinematics, random), qd = randomDirection(q.size(), random);
    const Moving now = at(constraints, q, qd, here, jacobian);
    VectorXd velocity(now.where.size());
    velocity.setZero();
    for (int row = 0; row < pairs; ++row) {
      const RowAnswer a = constraints.answer(row);
      velocity.segment<9>(9 * row) << a.normalVelocity, a.pointVelocity[0], a.pointVelocity[1];
    }
    const Moving after = at(constraints, q + kStep * qd, qd, other, otherJacobian);
    const Moving before = at(constraints, q - kStep * qd, qd, other, otherJacobian);
    found.speed = std::max(found.speed, (jacobian * qd - here.speed).cwiseAbs().maxCoeff());
    for (int row = 0; row < constraints.rows(); ++row) {
      if (row < pairs && here.d[row] < -0.01) continue;
      const auto part = [&](const VectorXd& v) { return v.segment<9>(9 * row); };
      const double forward = (after.speed[row] - now.speed[row]) / kStep,
                   backward = (now.speed[row] - before.speed[row]) / kStep;
      const VectorXd goes = (part(after.where) - part(now.where)) / kStep,
                     went = (part(now.where) - part(before.where)) / kStep;
      if (std::abs(forward - backward) > 1e-3 * (1 + std::abs(here.drift[row])) ||
          (goes - went).norm() > 1e-3 * (1 + part(velocity).norm())) {
        ++found.boundaries;
        continue;
      }
      ++found.compared;
      found.drift = std::max(found.drift, std::abs((forward + backward) / 2 - here.drift[row]));
      if (row < pairs && constraints.answer(row).status != DistanceStatus::invalid)
        found.velocity = std::max(found.velocity, ((goes + went) / 2 - part(velocity)).norm());
    }
  }
  return found;
}

// A central difference has two errors. One is step^2 / 6 times a third derivative, which is below 1e5 here if
// no region boundary is in the step. The other is rounding divided by the step: 1e-14 for the normal, and up
// to R times 1e-15 for a witness point on a face.
constexpr double kDifference = 1e-7;
// J times qd compared with the same sum by bodies: a hundred products of size 1.
constexpr double kRounding = 1e-13;

void check(CollisionConstraints& constraints, const Kinematics& kinematics, int count) {
  const Found found = compare(constraints, kinematics, count);
  INFO(found.compared << " compared, " << found.boundaries << " across a boundary");
  CHECK(found.speed < kRounding);
  CHECK(found.drift < kDifference);
  CHECK(found.velocity < kDifference);
  CHECK(found.compared > 500);
  CHECK(found.boundaries < found.compared / 50);
}

/// A floating robot among plain shapes, with the bend and a smooth constraint.
CollisionConstraints crowded(const Problem& p) {
  const std::vector<std::shared_ptr<fcl::CollisionGeometryd>> shapes{
      std::make_shared<fcl::Boxd>(0.3, 0.2, 0.4), std::make_shared<fcl::Cylinderd>(0.1, 0.5),
      std::make_shared<fcl::Capsuled>(0.1, 0.5)};
  ConstraintOptions options;
  options.influence = 0.6;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const double angle = 2.1 * static_cast<double>(i);
    const fcl::CollisionObjectd object(shapes[i], Random(i).rotation(),
                                       Eigen::Vector3d(1.3 * std::cos(angle), 1.3 * std::sin(angle), 0.5));
    options.obstacles.push_back(obstacleOf(object, "shape"));
  }
  options.smooth = {product()};
  std::vector<CheckedPair> pairs =
      obstaclePairs(*p.model, *p.geometry, static_cast<int>(shapes.size()), true);
  pairs.insert(pairs.end(), p.pairs.begin(), p.pairs.begin() + 40);
  return CollisionConstraints(p.kinematics, p.geometry, pairs, options);
}

}  // namespace

TEST_CASE("speed, drift and the velocities of normal and witness points are what differences along qd say") {
  for (const TestRobot& robot : robots()) {
    const Problem p = problem(robot);
    CollisionConstraints constraints(p.kinematics, p.geometry, p.pairs);
    INFO(robot.name);
    check(constraints, *p.kinematics, 20);
  }
}

TEST_CASE("rates hold for a floating base, plain shapes, the bend and constraints of one's own") {
  const Problem p = problem(robots()[0], BaseMotion::floating);
  CollisionConstraints constraints = crowded(p);
  check(constraints, *p.kinematics, 40);
}

TEST_CASE("without a velocity an answer does not move") {
  const Problem p = problem(robots()[0]);
  CollisionConstraints constraints(p.kinematics, p.geometry, p.pairs);
  RowRates rates = constraints.makeRates();
  MatrixXd jacobian(constraints.rows(), constraints.columns());
  const VectorXd q = p.kinematics->neutral(), qd = VectorXd::Ones(q.size());
  VectorXd d(constraints.rows());
  constraints.evaluate(q, qd, rates, jacobian);
  CHECK(constraints.answer(0).normalVelocity.norm() + constraints.answer(0).pointVelocity[0].norm() > 0);
  constraints.evaluate(q, d);
  CHECK(constraints.answer(0).normalVelocity.isZero(0));
  // The rates are also still after a product with a direction, or if nothing is known. Then the gradient has
  // no bound.
  const VectorXd none = VectorXd::Constant(q.size(), std::nan(""));
  VectorXd product(q.size());
  const auto isStill = [&] {
    const RowAnswer a = constraints.answer(0);
    CHECK(a.normalVelocity.isZero(0));
    CHECK(a.pointVelocity[0].isZero(0));
    CHECK(std::isinf(constraints.gradientRateBound(0)));
    constraints.evaluate(q, qd, rates, jacobian);
    CHECK(constraints.gradientRateBound(0) > 0);
    CHECK(std::isfinite(constraints.gradientRateBound(0)));
  };
  isStill();
  constraints.hessianVector(q, d, VectorXd::Zero(q.size()), product);
  isStill();
  constraints.evaluate(none, d);
  isStill();
  constraints.evaluate(none, qd, rates, jacobian);
  isStill();
  constraints.evaluate(q, none, rates, jacobian);
  isStill();
  constraints.evaluate(q, VectorXd::Zero(q.size()), rates, jacobian);
  CHECK(rates.speed.isZero(0));
  CHECK(rates.drift.isZero(0));
}

TEST_CASE("a row's Hessian has the products with vectors as columns, and qd' H qd is the drift") {
  const Problem p = problem(robots()[0], BaseMotion::floating);
  CollisionConstraints constraints = crowded(p);
  const int n = constraints.columns();
  Random random(5);
  RowRates rates = constraints.makeRates();
  MatrixXd jacobian(constraints.rows(), n), h(n, n);
  VectorXd product(n);
  int closed = 0;
  for (int trial = 0; trial < 3; ++trial) {
    const VectorXd q = randomConfiguration(*p.kinematics, random), v = randomDirection(n, random);
    constraints.evaluate(q, v, rates, jacobian);
    for (int row = trial; row < constraints.rows(); row += 4) {
      if (rates.d[row] < 0) continue;  // deep answers may have no second derivative
      constraints.hessian(q, row, h);
      constraints.hessianVector(q, VectorXd::Unit(constraints.rows(), row), v, product);
      CHECK((h - h.transpose()).isZero(0));
      // Sums of some hundred products. Levers divided by radii of curvature give entries of up to 1e3.
      CHECK((h * v - product).norm() < 1e-12 * (1 + h.norm()));
      CHECK(std::abs(v.dot(h * v) - rates.drift[row]) < 1e-12 * (1 + h.norm()));
      closed += h.norm() > 0;
    }
  }
  CHECK(closed > 20);
  // The smooth constraint, by differences: 2 q2 q5^2 has second derivatives of size 1. The gradient's
  // rounding divided by the step is 1e-10.
  const VectorXd q = randomConfiguration(*p.kinematics, random);
  constraints.hessian(q, constraints.rows() - 1, h);
  CHECK(std::abs(h(2, 5) - 2 * q[5]) < 1e-8);
  CHECK(std::abs(h(5, 5) - 2 * q[2]) < 1e-8);
  CHECK(std::abs(h(2, 2)) < 1e-8);
}

TEST_CASE("Hessians and gradient bounds hold where the joints of one coordinate carry and part two bodies") {
  // A finger: J carries both bodies; K between them and L after it follow J.
  const char* const finger = R"(<robot name="finger"><link name="palm"/>
    <link name="a"><collision><geometry><box size="0.2 0.1 0.1"/></geometry></collision></link><link name="b"/>
    <link name="c"><collision><origin xyz="0.1 0.02 0.3"/><geometry><box size="0.1 0.2 0.1"/></geometry></collision></link>
    <joint name="j" type="revolute"><parent link="palm"/><child link="a"/><axis xyz="0 1 0.2"/>
      <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
    <joint name="k" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0.2 0 0.1"/><axis xyz="0.1 1 0"/>
      <limit lower="-1" upper="1" effort="1" velocity="1"/><mimic joint="j" multiplier="0.8"/></joint>
    <joint name="l" type="revolute"><parent link="b"/><child link="c"/><origin xyz="0.05 0 0.01"/><axis xyz="0 1 0"/>
      <limit lower="-1" upper="1" effort="1" velocity="1"/><mimic joint="j" multiplier="1.1"/></joint></robot>)";
  const auto model = std::make_shared<const RobotModel>(parseUrdf(finger, "finger.urdf"));
  GeometryOptions options;
  options.radii = {0.01, 10};
  auto geometry = std::make_shared<RobotGeometry>(loadGeometry(*model, options));
  std::vector<CheckedPair> pairs = selfPairs(*model, *geometry, nullptr);
  coverPrimitives(pairs, *geometry);
  CollisionConstraints constraints(std::make_shared<const Kinematics>(model), geometry, pairs, {});
  REQUIRE(constraints.rows() == 1);
  RowRates rates = constraints.makeRates();
  MatrixXd jacobian(1, 1), h(1, 1), before(1, 1), after(1, 1);
  VectorXd product(1), d(1);
  double nearest = 0;
  for (int i = -100; i <= 100; ++i) {
    const VectorXd q = VectorXd::Constant(1, 0.01 * i), one = VectorXd::Ones(1);
    constraints.evaluate(q, one, rates, jacobian);
    const double bound = constraints.gradientRateBound(0);
    constraints.hessian(q, 0, h);
    constraints.hessianVector(q, one, one, product);
    CAPTURE(q, rates.d, bound);
    CHECK(std::abs(h(0, 0) - product[0]) < 1e-12 * (1 + h.norm()));
    CHECK(std::abs(h(0, 0) - rates.drift[0]) < 1e-12 * (1 + h.norm()));
    if (!(rates.d[0] > 0.01)) continue;
    constraints.evaluate(q + kStep * one, d, after);
    constraints.evaluate(q - kStep * one, d, before);
    const double change = std::abs(after(0, 0) - before(0, 0)) / (2 * kStep);
    CHECK(change <= bound * (1 + 1e-6) + 1e-9);  // the gradient's rounding divided by the step
    nearest = std::max(nearest, change / bound);
  }
  CHECK(nearest > 0.7);  // otherwise the bound would be too wide to test anything
}

TEST_CASE("the Lagrangian's Hessian is the weighted sum of the rows', in a structure that stays") {
  const Problem p = problem(robots()[0], BaseMotion::floating);
  CollisionConstraints constraints = crowded(p);
  const int n = constraints.columns();
  Random random(8);
  CollisionConstraints::SparseHessian lower = constraints.makeHessian();
  const std::vector<int> structure(lower.innerIndexPtr(), lower.innerIndexPtr() + lower.nonZeros());
  VectorXd weights(constraints.rows());
  for (Eigen::Index i = 0; i < weights.size(); ++i) weights[i] = i % 3 == 0 ? 0 : random.uniform(-1, 1);
  const VectorXd q = p.kinematics->neutral() + 0.3 * randomDirection(n, random);
  constraints.hessian(q, weights, lower);
  MatrixXd sum = MatrixXd::Zero(n, n), h(n, n);
  for (int row = 0; row < constraints.rows(); ++row) {
    if (weights[row] == 0) continue;
    constraints.hessian(q, row, h);
    sum += weights[row] * h;
  }
  CHECK(std::vector<int>(lower.innerIndexPtr(), lower.innerIndexPtr() + lower.nonZeros()) == structure);
  CHECK((MatrixXd(lower) - MatrixXd(sum.triangularView<Eigen::Lower>())).norm() < 1e-12 * (1 + sum.norm()));
  CHECK(sum.norm() > 1);
}

TEST_CASE("a sparse matrix of another structure is refused, and left as it is") {
  const Problem p = problem(robots()[0], BaseMotion::floating);
  CollisionConstraints constraints = crowded(p);
  const int n = constraints.columns();
  const VectorXd q = p.kinematics->neutral(), weights = VectorXd::Ones(constraints.rows());
  CollisionConstraints::SparseHessian lower = constraints.makeHessian(), none, empty(n, n), more = lower;
  more.coeffRef(0, n - 1) = 3;  // above the diagonal
  CollisionConstraints::SparseHessian moved(n, n);
  for (int k = 0; k < lower.nonZeros(); ++k) moved.insert(k / n, k % n) = 3;
  moved.makeCompressed();
  for (CollisionConstraints::SparseHessian* other : {&none, &empty, &more, &moved}) {
    const MatrixXd before = *other;
    CHECK_THROWS_WITH(constraints.hessian(q, weights, *other), Catch::Contains("makeHessian"));
    CHECK(MatrixXd(*other) == before);
  }
  CHECK(constraints.hessian(q, weights, lower));
  // A matrix of another size with the same number of entries, and a matrix with spare room.
  CollisionConstraints::SparseJacobian jacobian = constraints.makeJacobian();
  CollisionConstraints::SparseJacobian wide(1, constraints.nonZeros()), loose = jacobian;
  for (int k = 0; k < constraints.nonZeros(); ++k) wide.insert(0, k) = 1;
  wide.makeCompressed();
  loose.uncompress();
  VectorXd d(constraints.rows());
  RowRates rates = constraints.makeRates();
  for (CollisionConstraints::SparseJacobian* other : {&wide, &loose}) {
    CHECK_THROWS_WITH(constraints.evaluate(q, d, *other), Catch::Contains("makeJacobian"));
    CHECK_THROWS_WITH(constraints.evaluate(q, 0 * q, rates, *other), Catch::Contains("makeJacobian"));
  }
  CHECK(constraints.evaluate(q, d, jacobian));
}
