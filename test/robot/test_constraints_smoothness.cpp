// J(q) is continuous, and its change along a vector is the result of hessianVector().
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>

#include <catch2/catch.hpp>

#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "test/reference/robots.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

namespace {

// The gradient of one pair along a line of configurations.
class Line {
 public:
  Line(const Problem& p, const CheckedPair& pair, Eigen::VectorXd from, Eigen::VectorXd to)
      : constraints_(p.kinematics, p.geometry, {pair}),
        from_(std::move(from)),
        to_(std::move(to)),
        d_(1),
        values_(constraints_.nonZeros()) {}

  Eigen::VectorXd gradient(double s) {
    constraints_.evaluateValues(from_ + s * (to_ - from_), d_, values_);
    return values_;
  }

  // Repeatedly takes the half in which the gradient changes more, down to a length of 2^-40. @returns the
  // change there.
  double jump(double low, double high) {
    Eigen::VectorXd atLow = gradient(low), atHigh = gradient(high);
    while (high - low > 0x1p-40) {
      const double middle = (low + high) / 2;
      const Eigen::VectorXd atMiddle = gradient(middle);
      const bool left = (atMiddle - atLow).norm() > (atHigh - atMiddle).norm();
      (left ? high : low) = middle;
      (left ? atHigh : atLow) = atMiddle;
    }
    return (atHigh - atLow).norm();
  }

 private:
  CollisionConstraints constraints_;
  Eigen::VectorXd from_, to_, d_, values_;
};

// Whether the overlap is at most half the margins, so that by theory the gradient changes by at most lever^2
// / (margins / 2) per radian.
bool smoothThere(const DistanceAnswer& answer) {
  return answer.status == DistanceStatus::exact && answer.continuous && answer.distance > -0.01;
}

// Moves a coordinate over its range, and searches for a jump in each row where the row changed most.
double worstJump(const Problem& p, const Eigen::VectorXd& posture, int coordinate) {
  constexpr int kSteps = 100;
  CollisionConstraints constraints(p.kinematics, p.geometry, p.pairs);
  Eigen::VectorXd from = posture, to = posture, d(constraints.rows());
  from[coordinate] = std::max(p.kinematics->lower()[coordinate], -M_PI);
  to[coordinate] = std::min(p.kinematics->upper()[coordinate], M_PI);
  const std::size_t rows = static_cast<std::size_t>(constraints.rows());
  std::vector<double> most(rows, 0);
  std::vector<int> where(rows, -1);
  Eigen::VectorXd values(constraints.nonZeros()), last(values);
  std::vector<char> smooth(rows, 0);
  for (int step = 0; step <= kSteps; ++step) {
    constraints.evaluateValues(from + step / static_cast<double>(kSteps) * (to - from), d, values);
    for (std::size_t row = 0; row < rows; ++row) {
      const bool was = smooth[row];
      smooth[row] = smoothThere(constraints.answer(static_cast<int>(row)));
      if (!was || !smooth[row]) continue;
      const int first = constraints.rowStart()[row], count = constraints.rowStart()[row + 1] - first;
      const double change = (values.segment(first, count) - last.segment(first, count)).norm();
      if (change <= most[row]) continue;
      most[row] = change;
      where[row] = step;
    }
    last = values;
  }
  double worst = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    if (where[row] < 0) continue;
    Line line(p, p.pairs[row], from, to);
    worst = std::max(worst, line.jump((where[row] - 1.0) / kSteps, where[row] / static_cast<double>(kSteps)));
  }
  return worst;
}

// Largest difference between a row's part of hessianVector() and the change of its gradient. Rows whose
// one-sided differences show a region boundary in between are left out and counted.
struct SecondOrder {
  double worst = 0;
  int compared = 0, boundaries = 0;
};

// By how much the sum of all rows' Hessians is not symmetric, along two random directions and relative to its
// size.
double asymmetry(CollisionConstraints& constraints, const Eigen::VectorXd& q, Random& random) {
  const Eigen::VectorXd weights = Eigen::VectorXd::Ones(constraints.rows()),
                        u = randomDirection(q.size(), random), v = randomDirection(q.size(), random);
  Eigen::VectorXd hu(q.size()), hv(q.size());
  constraints.hessianVector(q, weights, u, hu);
  constraints.hessianVector(q, weights, v, hv);
  return std::abs(v.dot(hu) - u.dot(hv)) / (1 + hu.norm() + hv.norm());
}

SecondOrder secondOrder(CollisionConstraints& constraints, const Kinematics& kinematics, int count) {
  constexpr double step = 1e-6;
  Random random(11);
  SecondOrder result;
  Eigen::VectorXd d(constraints.rows()), out(constraints.columns());
  Eigen::MatrixXd here(constraints.rows(), constraints.columns()), after(here), before(here);
  for (int trial = 0; trial < count; ++trial) {
    const Eigen::VectorXd q = randomConfiguration(kinematics, random);
    const Eigen::VectorXd v = randomDirection(q.size(), random);
    constraints.evaluate(q, d, here);
    std::vector<int> rows;
    for (int k = 0; k < 10; ++k) {
      const int row = random.below(constraints.rows());
      const bool pair = static_cast<std::size_t>(row) < constraints.pairs().size();
      if (!pair || d[row] > -0.01) rows.push_back(row);
    }
    constraints.evaluate(q + step * v, d, after);
    constraints.evaluate(q - step * v, d, before);
    for (int row : rows) {
      const Eigen::VectorXd forward = (after.row(row) - here.row(row)) / step;
      const Eigen::VectorXd backward = (here.row(row) - before.row(row)) / step;
      constraints.hessianVector(q, Eigen::VectorXd::Unit(constraints.rows(), row), v, out);
      if ((forward - backward).norm() > 1e-3 * (1 + out.norm())) {
        ++result.boundaries;
        continue;
      }
      ++result.compared;
      result.worst = std::max(result.worst, ((forward + backward) / 2 - out).norm());
    }
  }
  return result;
}

// If no region boundary lies in the step, a central difference is off by step^2 times a third derivative,
// which is below 1e4 here, and by the gradient's rounding, about 1e-14, divided by the step.
constexpr double kSecond = 1e-7;

}  // namespace

TEST_CASE("no joint of any robot, swept over its range, makes the Jacobian jump") {
  for (const TestRobot& robot : robots()) {
    const Problem p = problem(robot);
    INFO(robot.name);
    Random random(5);
    for (const Eigen::VectorXd& posture :
         {p.kinematics->neutral(), randomConfiguration(*p.kinematics, random)})
      for (int k = 0; k < p.kinematics->size(); ++k) {
        INFO(p.kinematics->names()[static_cast<std::size_t>(k)]);
        // 2^-40 of at most 2 pi, times the slope of at most 2.25 / 0.01 per rad, is 1.3e-9; rounding is less.
        CHECK(worstJump(p, posture, k) < 2e-9);
      }
  }
}

TEST_CASE("a Hessian-vector product is the change of the gradient along the vector") {
  for (const TestRobot& robot : robots()) {
    const Problem p = problem(robot);
    CollisionConstraints constraints(p.kinematics, p.geometry, p.pairs);
    const SecondOrder found = secondOrder(constraints, *p.kinematics, 100);
    INFO(robot.name << ": " << found.compared << " compared, " << found.boundaries << " across a boundary");
    CHECK(found.worst < kSecond);
    CHECK(found.compared > 500);
    CHECK(found.boundaries < found.compared / 100);
  }
}

TEST_CASE(
    "Hessian-vector products hold for a floating base, obstacles, the bend and constraints of one's own") {
  const Problem p = problem(robots()[0], BaseMotion::floating);
  ConstraintOptions options;
  options.influence = 0.3;
  fcl::CollisionObjectd ball(std::make_shared<StpBvGeometry>(StpBv::build(geodesicSphere(0.2, 2))));
  ball.setTranslation(Eigen::Vector3d(0.6, 0.5, 0));
  options.obstacles = {obstacleOf(ball, "ball")};
  options.smooth = {product()};
  std::vector<CheckedPair> pairs = obstaclePairs(*p.model, *p.geometry, 1, true);
  pairs.insert(pairs.end(), p.pairs.begin(), p.pairs.begin() + 40);
  CollisionConstraints constraints(p.kinematics, p.geometry, pairs, options);
  const SecondOrder found = secondOrder(constraints, *p.kinematics, 100);
  CHECK(found.worst < kSecond);
  CHECK(found.compared > 500);

  Random random(3);
  CHECK(asymmetry(constraints, randomConfiguration(*p.kinematics, random), random) < 1e-8);
}

TEST_CASE(
    "Hessian-vector products of rows against plain shapes and a mesh are closed forms, not differences") {
  const Problem p = problem(robots()[0], BaseMotion::floating);
  const auto mesh = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  mesh->beginModel();
  mesh->addTriangle({-1, -1, 0}, {1, -1, 0.1}, {-1, 1, 0.2});
  mesh->addTriangle({1, -1, 0.1}, {1, 1, 0}, {-1, 1, 0.2});
  mesh->endModel();
  const std::vector<std::shared_ptr<fcl::CollisionGeometryd>> shapes{
      std::make_shared<fcl::Boxd>(0.3, 0.2, 0.4), std::make_shared<fcl::Cylinderd>(0.1, 0.5),
      std::make_shared<fcl::Capsuled>(0.1, 0.5), mesh};
  ConstraintOptions options;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    fcl::CollisionObjectd object(shapes[i], Random(i).rotation(),
                                 Eigen::Vector3d(2.5 * std::cos(1.5 * static_cast<double>(i)),
                                                 2.5 * std::sin(1.5 * static_cast<double>(i)), 0.5));
    options.obstacles.push_back(obstacleOf(object, "shape"));
  }
  const std::vector<CheckedPair> pairs =
      obstaclePairs(*p.model, *p.geometry, static_cast<int>(shapes.size()), true);
  CollisionConstraints constraints(p.kinematics, p.geometry, pairs, options);
  const SecondOrder found = secondOrder(constraints, *p.kinematics, 100);
  INFO(found.compared << " compared, " << found.boundaries << " across a boundary");
  CHECK(found.worst < kSecond);
  CHECK(found.compared > 500);
  CHECK(found.boundaries < found.compared / 50);

  // A closed form is symmetric to rounding, differences are symmetric to about 1e-9.
  Random random(3);
  double worst = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::VectorXd q = randomConfiguration(*p.kinematics, random);
    Eigen::VectorXd d(constraints.rows());
    constraints.evaluate(q, d);
    if (d.minCoeff() < 0) continue;  // deep answers may have no second derivative
    worst = std::max(worst, asymmetry(constraints, q, random));
  }
  CHECK(worst > 0);
  CHECK(worst < 1e-13);
}
