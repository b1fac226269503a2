// d(q) and J(q) of whole robots: compared with differences, across the influence distance, with obstacles,
// without allocation.
#include <fcl/geometry/shape/sphere.h>

#include <catch2/catch.hpp>
#include <limits>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/constraints.h"
#include "test/reference/robots.h"
#include "test/reference/shapes.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

namespace {

// Largest difference between J v and the central difference of d along v, over rows that are exact.
double worstError(CollisionConstraints& constraints, const Kinematics& kinematics, int count) {
  Random random(7);
  constexpr double step = 1e-6;
  Eigen::VectorXd d(constraints.rows()), after(d), before(d);
  Eigen::MatrixXd jacobian(constraints.rows(), constraints.columns());
  double worst = 0;
  for (int trial = 0; trial < count; ++trial) {
    const Eigen::VectorXd q = randomConfiguration(kinematics, random);
    const Eigen::VectorXd v = randomDirection(q.size(), random);
    constraints.evaluate(q, d, jacobian);
    const Eigen::VectorXd slope = jacobian * v;
    std::vector<bool> exact;
    for (std::size_t row = 0; row < constraints.pairs().size(); ++row) {
      const DistanceAnswer& answer = constraints.answer(static_cast<int>(row));
      exact.push_back(answer.status == DistanceStatus::exact || answer.status == DistanceStatus::invalid);
    }
    exact.resize(static_cast<std::size_t>(constraints.rows()), true);
    constraints.evaluate(q + step * v, after);
    constraints.evaluate(q - step * v, before);
    for (Eigen::Index row = 0; row < d.size(); ++row) {
      if (exact[static_cast<std::size_t>(row)])
        worst = std::max(worst, std::abs((after[row] - before[row]) / (2 * step) - slope[row]));
    }
  }
  return worst;
}

// The second derivative jumps across a region boundary by at most lever^2 / (r1 + r2) = 1 / 0.02 per m. A
// difference over a step is off by a quarter of that times the step. Levers here are up to about 1.5 m.
constexpr double kDifference = 1e-6 / 4 * 2.25 / 0.02;

}  // namespace

TEST_CASE("the Jacobian agrees with central differences on 1000 configurations of every robot") {
  for (const TestRobot& robot : robots()) {
    const Problem p = problem(robot);
    CollisionConstraints constraints(p.kinematics, p.geometry, p.pairs);
    INFO(robot.name << ", " << constraints.rows() << " rows");
    REQUIRE(constraints.rows() > 20);
    CHECK(worstError(constraints, *p.kinematics, 1000) < kDifference);
  }
}

TEST_CASE("the Jacobian holds for a floating base among obstacles, and the base does not enter self pairs") {
  const Problem p = problem(robots()[0], BaseMotion::floating);
  ConstraintOptions options;
  const auto ball = std::make_shared<StpBvGeometry>(StpBv::build(geodesicSphere(0.2, 2)));
  fcl::CollisionObjectd object(ball);
  object.setTranslation(Eigen::Vector3d(1.5, 0.5, 0));
  options.obstacles = {obstacleOf(object, "ball")};
  std::vector<CheckedPair> pairs = p.pairs;
  for (const CheckedPair& pair : obstaclePairs(*p.model, *p.geometry, 1, true)) pairs.push_back(pair);
  CollisionConstraints constraints(p.kinematics, p.geometry, pairs, options);
  CHECK(constraints.rows() == static_cast<int>(p.pairs.size() + p.geometry->bodies.size()));
  CHECK(worstError(constraints, *p.kinematics, 100) < kDifference);
  CHECK(constraints.columnIndices()[0] >= 6);
}

TEST_CASE("rows bend over smoothly to a constant at the influence distance") {
  const Problem p = problem(robots()[0]);
  ConstraintOptions options;
  options.influence = 0.2;
  CollisionConstraints bent(p.kinematics, p.geometry, p.pairs, options),
      plain(p.kinematics, p.geometry, p.pairs);
  CHECK(worstError(bent, *p.kinematics, 300) < kDifference);
  Random random(3);
  Eigen::VectorXd d(bent.rows()), exact(bent.rows());
  const Eigen::VectorXd q = randomConfiguration(*p.kinematics, random);
  bent.evaluate(q, d);
  plain.evaluate(q, exact);
  int far = 0;
  for (Eigen::Index row = 0; row < d.size(); ++row) {
    if (exact[row] <= 0.1) CHECK(d[row] == exact[row]);
    if (exact[row] >= 0.2) CHECK(d[row] == Approx(0.15).epsilon(1e-14));
    far += bent.answer(static_cast<int>(row)).status == DistanceStatus::invalid;
  }
  CHECK(far > bent.rows() / 4);
}

TEST_CASE("sparse and dense evaluations give the same numbers") {
  const Problem p = problem(robots()[0]);
  CollisionConstraints one(p.kinematics, p.geometry, p.pairs), other(p.kinematics, p.geometry, p.pairs);
  Random random(5);
  Eigen::VectorXd d1(one.rows()), d2(one.rows());
  Eigen::MatrixXd dense(one.rows(), one.columns());
  CollisionConstraints::SparseJacobian sparse = other.makeJacobian();
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::VectorXd q = randomConfiguration(*p.kinematics, random);
    one.evaluate(q, d1, dense);
    other.evaluate(q, d2, sparse);
    CHECK(d1 == d2);
    CHECK(dense == Eigen::MatrixXd(sparse));
  }
}

TEST_CASE("a smooth constraint takes the place of the pairs it replaces") {
  const Problem p = problem(robots()[0]);
  ConstraintOptions options;
  SmoothConstraint shoulder;
  shoulder.name = "left shoulder";
  shoulder.coordinates = {2, 5};
  shoulder.value = [](const Eigen::Ref<const Eigen::VectorXd>& q, double* gradient) {
    if (gradient) {
      gradient[0] = 2 * q[2];
      gradient[1] = 1;
    }
    return q[2] * q[2] + q[5];
  };
  shoulder.replaces = {{"LARM_LINK2", "CHEST_LINK1"}};
  options.smooth = {shoulder};
  CollisionConstraints constraints(p.kinematics, p.geometry, p.pairs, options);
  CHECK(constraints.rows() == static_cast<int>(p.pairs.size()));  // one row was removed and one added
  CHECK(constraints.name(constraints.rows() - 1) == "left shoulder");
  CHECK(constraints.answer(constraints.rows() - 1).status == DistanceStatus::invalid);
  CHECK(constraints.gradientRateBound(constraints.rows() - 1) == std::numeric_limits<double>::infinity());
  CHECK(worstError(constraints, *p.kinematics, 20) < kDifference);
}

TEST_CASE("rows that do not exist and numbers of another size are refused") {
  const Problem p = problem(robots()[0]);
  CollisionConstraints c(p.kinematics, p.geometry, p.pairs);
  Eigen::VectorXd q = p.kinematics->neutral(), d(c.rows()), values(c.nonZeros()), v(q.size()), out(q.size());
  const Eigen::VectorXd more = Eigen::VectorXd::Zero(q.size() + 1), less = more.head(q.size() - 1);
  Eigen::VectorXd few(c.rows() - 1), fewValues(c.nonZeros() - 1);
  Eigen::MatrixXd wide(c.rows(), c.columns() + 1), full(c.columns(), c.columns());
  RowRates rates = c.makeRates(), short1 = rates;
  short1.drift = few;
  v.setOnes();
  for (const Eigen::VectorXd& wrong : {more, less}) {
    CHECK_THROWS_WITH(c.evaluate(wrong, d), Catch::Contains(": q has the size"));
    CHECK_THROWS_WITH(c.evaluateValues(q, wrong, rates, values), Catch::Contains(": qd has the size"));
    Eigen::VectorXd room = wrong;
    CHECK_THROWS_WITH(c.hessianVector(q, d, wrong, out), Catch::Contains(": v has the size"));
    CHECK_THROWS_WITH(c.hessianVector(q, d, v, room), Catch::Contains(": the result has the size"));
  }
  CHECK_THROWS_WITH(c.evaluate(q, few), Catch::Contains(": d has the size"));
  CHECK_THROWS_AS(c.evaluate(q, d, wide), Error);
  CHECK_THROWS_AS(c.evaluateValues(q, d, fewValues), Error);
  CHECK_THROWS_WITH(c.evaluateValues(q, v, short1, values), Catch::Contains(": drift has the size"));
  CHECK_THROWS_WITH(c.hessianVector(q, few, v, out), Catch::Contains(": weights has the size"));
  auto lower = c.makeHessian();
  CHECK_THROWS_WITH(c.hessian(q, few, lower), Catch::Contains(": weights has the size"));
  for (const int row : {-1, c.rows()}) {
    CHECK_THROWS_AS(c.name(row), Error);
    CHECK_THROWS_AS(c.answer(row), Error);
    CHECK_THROWS_AS(c.gradientRateBound(row), Error);
    CHECK_THROWS_AS(c.hessian(q, row, full), Error);
  }
  for (const Eigen::Index rows : {c.columns() - 1, c.columns()}) {
    Eigen::MatrixXd other = Eigen::MatrixXd::Zero(rows, c.columns() - 1);
    CHECK_THROWS_WITH(c.hessian(q, 0, other), Catch::Contains("Hessian"));
  }
  ConstraintOptions replacing;
  replacing.smooth.push_back({"left shoulder",
                              {2},
                              [](const Eigen::Ref<const Eigen::VectorXd>&, double*) { return 1.0; },
                              {{"LARM_LINK2", "CHEST_LINK1"}}});
  CHECK_THROWS_AS(CollisionConstraints(p.kinematics, p.geometry, {{0, 999, false}}, replacing), Error);
}

TEST_CASE("Hessians leave rows of weight 0 out, and take weights that would overflow for no numbers") {
  const Problem p = problem(robots()[0]);
  ConstraintOptions options;
  options.smooth = {{"nowhere",
                     {0, 1},
                     [](const auto&, double* gradient) {
                       if (gradient) gradient[0] = gradient[1] = std::numeric_limits<double>::quiet_NaN();
                       return std::numeric_limits<double>::quiet_NaN();
                     },
                     {}}};
  CollisionConstraints constraints(p.kinematics, p.geometry, p.pairs, options);
  const Eigen::VectorXd q = p.kinematics->neutral(), v = Eigen::VectorXd::Ones(q.size());
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(constraints.rows()), product(q.size());
  weights[constraints.rows() - 1] = 0;
  CollisionConstraints::SparseHessian lower = constraints.makeHessian();
  CHECK(constraints.hessian(q, weights, lower));
  CHECK(constraints.hessianVector(q, weights, v, product));
  const Eigen::VectorXd expected = Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>() * v;
  CHECK((product - expected).norm() <= 1e-12 * (1 + expected.norm()));
  for (const double huge : {1e200, -1e308}) {
    weights.setConstant(huge);
    CHECK(!constraints.hessian(q, weights, lower));
    CHECK(!constraints.hessianVector(q, weights, v, product));
    CHECK(Eigen::MatrixXd(lower).isZero(0));
    CHECK(product.isZero(0));
  }
}
