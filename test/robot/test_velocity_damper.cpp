// The velocity damper's rows, how they come and go, and the bounds of docs/control.md.
#include <fcl/geometry/shape/box.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/velocity_damper.h"
#include "test/reference/robots.h"
#include "test/reference/shapes.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kPeriod = 1e-3;

/// The left arm of the robot in data/ holds a box of 14 x 10 x 6 cm over a table: one pair.
struct Held {
  Problem problem = fcl_stpbv::test::problem(robots()[0]);
  VectorXd q;
  std::unique_ptr<CollisionConstraints> constraints;

  Held(double r, double R, double gap, double influence = std::numeric_limits<double>::infinity()) {
    q = problem.kinematics->neutral();
    const auto set = [&](const char* joint, double value) {
      q[problem.kinematics->coordinate(joint)] = value;
    };
    set("LARM_JOINT0", -0.6);
    set("LARM_JOINT1", 0.25);
    set("LARM_JOINT3", -1.2);
    Kinematics::State state = problem.kinematics->makeState();
    problem.kinematics->forward(q, state);
    const int hand = problem.model->link("LARM_LINK5");
    const Eigen::Isometry3d& at = state.link[static_cast<std::size_t>(hand)];
    Eigen::Isometry3d level = Eigen::Isometry3d::Identity();
    level.translation() = at * Vector3d(0, 0, -0.16);
    const Body box =
        smoothBody(hand, "held", StpBv::build(test::box(0.14, 0.10, 0.06), {r, R}), at.inverse() * level);
    ConstraintOptions options;
    options.influence = influence;
    const auto table = std::make_shared<fcl::Boxd>(0.6, 0.8, 0.3);
    const fcl::CollisionObjectd object(table, Eigen::Matrix3d::Identity(),
                                       level.translation() - Vector3d(0, 0, 0.03 + r + gap + 0.15));
    constraints = singleRow(problem.kinematics, box, object, options);
  }
};

}  // namespace

TEST_CASE("rows at every level follow from d, J and the rates, sparse as dense") {
  Held held(0.01, 10, 0.02);
  const VectorXd qd = VectorXd::LinSpaced(held.q.size(), -0.3, 0.3);
  RowRates rates = held.constraints->makeRates();
  MatrixXd jacobian(1, held.q.size()), dense(jacobian);
  held.constraints->evaluate(held.q, qd, rates, jacobian);
  DamperOptions options;
  options.headroom = -1;
  const double rate = 0.5 / 0.04, allowed = -rate * (rates.d[0] - 0.01);
  const auto b = [&](DamperLevel level) {
    options.level = level;
    VelocityDamper damper(*held.constraints, options);
    damper.update(held.q, qd);
    VectorXd bound(1);
    REQUIRE(damper.dense(dense, bound) == 1);
    CHECK((dense - jacobian).norm() < 1e-14);  // a warm start changes the rounding
    CHECK(MatrixXd(damper.A()) == dense);
    CHECK(damper.b()[0] == bound[0]);
    return bound[0];
  };
  REQUIRE(rates.d[0] < 0.05);
  // Sums of a few numbers, divided by the period.
  CHECK(b(DamperLevel::velocity) == Approx(allowed).epsilon(1e-13));
  CHECK(b(DamperLevel::acceleration) ==
        Approx((allowed - rates.speed[0]) / kPeriod - rates.drift[0]).epsilon(1e-11));
  CHECK(b(DamperLevel::barrier) ==
        Approx(-rates.drift[0] - (rate + 50) * rates.speed[0] + 50 * allowed).epsilon(1e-11));
}

TEST_CASE(
    "a row that enters does not act on that tick, however fast the pair comes, and one that is far is no "
    "row") {
  for (const double speed : {0.1, 0.6, 2.0}) {
    Held held(0.01, 10, 0.08);
    VectorXd qd = VectorXd::Zero(held.q.size());
    VelocityDamper damper(*held.constraints, {});
    damper.update(held.q, qd);
    REQUIRE(damper.near().empty());
    CHECK(damper.b()[0] == -std::numeric_limits<double>::infinity());
    VectorXd q = held.q;
    int ticks = 0;
    while (damper.near().empty() && ++ticks < 3000) {
      const VectorXd gradient = MatrixXd(damper.A()).row(0);
      qd = -speed * gradient / gradient.squaredNorm();  // the distance shrinks at `speed`
      q += kPeriod * qd;
      damper.update(q, qd);
    }
    REQUIRE(damper.near().size() == 1);
    CHECK((damper.A() * qd)[0] >=
          damper.b()[0] + 0.04);  // the headroom of 0.05, minus the reduction of xi since d_i
    const double entered = damper.damping(0);
    CHECK(entered >= 0.5);
    CHECK((entered > 0.5) == (speed > 0.46));
    damper.update(q, 0 * qd);
    CHECK(damper.damping(0) == entered);  // stays until the pair leaves
    damper.update(held.q, qd);
    damper.update(q, 0 * qd);
    CHECK(damper.damping(0) == 0.5);
  }
}

TEST_CASE("no gradient changes faster than r, R, the distance and the velocities allow") {
  Random random(4);
  double tightest = 0;
  long compared = 0;
  const auto walk = [&](CollisionConstraints& constraints, const Kinematics& kinematics, int count) {
    RowRates rates = constraints.makeRates();
    MatrixXd jacobian(constraints.rows(), constraints.columns());
    VectorXd product(constraints.columns());
    for (int trial = 0; trial < count; ++trial) {
      const VectorXd q = randomConfiguration(kinematics, random), qd = randomDirection(q.size(), random);
      constraints.evaluate(q, qd, rates, jacobian);
      for (int k = 0; k < 15; ++k) {
        const int row = random.below(constraints.rows());
        constraints.evaluate(q, qd, rates, jacobian);
        const double bound = constraints.gradientRateBound(row);
        if (rates.d[row] < -0.01 || std::isinf(bound)) continue;
        constraints.hessianVector(q, VectorXd::Unit(constraints.rows(), row), qd, product);
        CHECK(product.norm() <= bound * (1 + 1e-9) + 1e-12);  // rounding
        if (bound > 0) tightest = std::max(tightest, product.norm() / bound);
        ++compared;
      }
    }
  };
  for (const TestRobot& robot : robots()) {
    const Problem p = problem(robot);
    CollisionConstraints constraints(p.kinematics, p.geometry, p.pairs);
    walk(constraints, *p.kinematics, 20);
  }
  for (const double R : {1.0, 10.0}) {
    Held held(0.001, R, 0.02);
    for (int trial = 0; trial < 200; ++trial) walk(*held.constraints, *held.problem.kinematics, 1);
  }
  INFO("closest to its bound " << tightest);
  CHECK(compared > 500);
  CHECK(tightest > 0.3);  // a bound that is never approached would show nothing
  CHECK(tightest <= 1 + 1e-9);
}

// One row and H = 1, so the program's solution is a projection and needs no solver.
TEST_CASE(
    "the joint acceleration that a collision row causes stays below its bound while a held box slides over a "
    "table") {
  Held held(0.01, 10, 0.03);
  VelocityDamper damper(*held.constraints, {});
  RowRates rates = held.constraints->makeRates();
  const Eigen::Index n = held.q.size();
  MatrixXd jacobian(1, n);
  VectorXd q = held.q, qd = VectorXd::Zero(n), a(n);
  double before = 0, tightest = 0, most = 0;
  VectorXd lastQd = qd, lastTask = qd;
  bool acted = false;
  int ticks = 0;
  for (int k = 0; k < 3000; ++k) {
    const double t = k * kPeriod;
    damper.update(q, qd);
    a = MatrixXd(damper.A()).row(0);
    VectorXd task(n);  // downwards, and to and fro with a different frequency for every joint
    for (Eigen::Index i = 0; i < n; ++i) task[i] = 0.05 * std::sin((2 + 0.3 * static_cast<double>(i)) * t);
    held.constraints->evaluate(q, qd, rates, jacobian);
    if (k == 0) lastTask = task;
    task -= 0.2 * jacobian.row(0).transpose() / jacobian.row(0).squaredNorm() * std::min(1.0, t);
    const double short_ = damper.b()[0] - a.dot(task);
    const bool acts = short_ > 0;
    const VectorXd x = acts ? VectorXd(task + a * short_ / a.squaredNorm()) : task;
    held.constraints->evaluate(q, x, rates, jacobian);  // the effect of the row during the next tick
    ProgramChange change;
    change.gradient = held.constraints->gradientRateBound(0);
    change.bound = damper.damping(0) / 0.04 * std::abs(rates.speed[0]);
    change.multiplier = acts ? short_ / a.squaredNorm() : 0;
    change.solution = x.norm();
    const double bound = collisionAccelerationBound(change, 1, a.squaredNorm());
    if (acts && acted) {
      const double measured = (x - lastQd).norm() / kPeriod,
                   allowed = (task - lastTask).norm() / kPeriod + std::max(bound, before);
      // The bound is for the derivative. Over a tick the rates themselves change by a few parts in a
      // thousand.
      CHECK(measured <= 1.01 * allowed);
      tightest = std::max(tightest, measured / allowed);
      most = std::max(most, measured);
      ++ticks;
    }
    before = bound;
    acted = acts;
    lastQd = x;
    lastTask = task;
    q += kPeriod * x;
    qd = x;
  }
  INFO("measured up to " << most << ", at most " << tightest << " of the bound, over " << ticks << " ticks");
  CHECK(ticks > 500);
  CHECK(tightest > 0.05);
}

TEST_CASE("a damper that makes no sense is refused with what would work") {
  Held held(0.01, 10, 0.02);
  DamperOptions options;
  options.all.influence = options.all.security;
  CHECK_THROWS_WITH(VelocityDamper(*held.constraints, options), Catch::Contains("influence"));
  options = {};
  options.rows[7] = {};
  CHECK_THROWS_WITH(VelocityDamper(*held.constraints, options), Catch::Contains("no row 7"));
  for (const Damper& wrong : {Damper{0.05, std::nan(""), 0.5}, Damper{0.01, 0.02, 0.5},
                              Damper{0.05, 0.05, 0.5}, Damper{0.05, 0.01, -1}}) {
    options.rows = {{0, wrong}};
    CHECK_THROWS_WITH(VelocityDamper(*held.constraints, options), Catch::Contains("of row 0"));
  }
  // Its rows bend from 2.5 cm to 3.75 cm.
  Held small(0.01, 10, 0.2, 0.05);
  CHECK(small.constraints->exactUpTo(0) == 0.025);
  options = {};
  for (const double bending : {0.05, 0.0375, 0.0251}) {
    options.all.influence = bending;
    CHECK_THROWS_WITH(VelocityDamper(*small.constraints, options), Catch::Contains("beyond 0.025 m"));
  }
  options.all = {0.025 * (1 + 4e-16), 0.025, 0.5};
  CHECK_THROWS_WITH(VelocityDamper(*small.constraints, options), Catch::Contains("larger than security"));
  options.all = {small.constraints->exactUpTo(0), 0.01, 0.5};
  VelocityDamper damper(*small.constraints, options);
  damper.update(small.q, 0 * small.q);
  CHECK(damper.near().empty());
}

TEST_CASE("numbers of another size, too little room and rows that do not exist are refused at every level") {
  Held held(0.01, 10, 0.02);
  const Eigen::Index n = held.q.size();
  for (const DamperLevel level : {DamperLevel::velocity, DamperLevel::acceleration, DamperLevel::barrier}) {
    DamperOptions options;
    options.level = level;
    VelocityDamper damper(*held.constraints, options);
    for (const Eigen::Index size : {Eigen::Index{0}, n - 1, n + 1}) {
      CHECK_THROWS_WITH(damper.update(held.q, VectorXd::Ones(size)), Catch::Contains("qd"));
      CHECK_THROWS_WITH(damper.update(VectorXd::Ones(size), 0 * held.q), Catch::Contains("q has the size"));
    }
    CHECK(damper.near().empty());
    CHECK(damper.damping(0) == 0.5);
    CHECK(damper.barrierGain(0) == 50);
    for (const int row : {-1, 1}) {
      CHECK_THROWS_WITH(damper.damping(row), Catch::Contains("no row"));
      CHECK_THROWS_WITH(damper.barrierGain(row), Catch::Contains("no row"));
    }
    damper.update(held.q, 0 * held.q);
    REQUIRE(damper.near().size() == 1);
    MatrixXd none(0, n), narrow(1, n - 1), room(2, n);
    VectorXd b(2), noB(0);
    CHECK_THROWS_WITH(damper.dense(none, b), Catch::Contains("1 rows of " + std::to_string(n)));
    CHECK_THROWS_WITH(damper.dense(narrow, b), Catch::Contains("1 rows of " + std::to_string(n)));
    CHECK_THROWS_WITH(damper.dense(room, noB), Catch::Contains("1 rows of " + std::to_string(n)));
    CHECK(damper.dense(room, b) == 1);
  }
}

TEST_CASE("a smooth constraint whose value is no number is near, with a row that nothing meets") {
  const auto model = std::make_shared<const RobotModel>(
      parseUrdf(robot(link("base") + link("b") + joint("x", "prismatic", "base", "b", "", 9)), "rail.urdf"));
  SmoothConstraint root;  // of 1 - q, which is NaN beyond 1
  root.name = "root";
  root.coordinates = {0};
  root.value = [](const Eigen::Ref<const VectorXd>& q, double* gradient) {
    const double value = std::sqrt(1 - q[0]);
    if (gradient) gradient[0] = -0.5 / value;
    return value;
  };
  ConstraintOptions options;
  options.smooth = {root};
  CollisionConstraints constraints(std::make_shared<const Kinematics>(model),
                                   std::make_shared<const RobotGeometry>(), {}, options);
  for (const DamperLevel level : {DamperLevel::velocity, DamperLevel::acceleration, DamperLevel::barrier}) {
    DamperOptions how;
    how.level = level;
    VelocityDamper damper(constraints, how);
    for (const double q : {0.0, 1.5, 0.0}) {
      damper.update(VectorXd::Constant(1, q), VectorXd::Ones(1));
      CHECK(damper.near().size() == (q > 1 ? 1 : 0));
      CHECK(damper.b()[0] == (q > 1 ? HUGE_VAL : -HUGE_VAL));
    }
  }
}

TEST_CASE("a row enters when it has a value, not before") {
  const auto model = std::make_shared<const RobotModel>(
      parseUrdf(robot(link("base") + link("b") + joint("x", "prismatic", "base", "b", "", 9)), "rail.urdf"));
  SmoothConstraint rest;  // of the way to 1, known from 0 on
  rest.name = "rest";
  rest.coordinates = {0};
  rest.value = [](const Eigen::Ref<const VectorXd>& q, double* gradient) {
    if (gradient) gradient[0] = -1;
    return q[0] < 0 ? std::nan("") : 1 - q[0];
  };
  ConstraintOptions options;
  options.smooth = {rest};
  CollisionConstraints constraints(std::make_shared<const Kinematics>(model),
                                   std::make_shared<const RobotGeometry>(), {}, options);
  const VectorXd unknown = VectorXd::Constant(1, -1), near = VectorXd::Constant(1, 0.97);
  const VectorXd fast = VectorXd::Constant(1, 2);
  for (const DamperLevel level : {DamperLevel::velocity, DamperLevel::acceleration, DamperLevel::barrier}) {
    DamperOptions how;
    how.level = level;
    VelocityDamper usual(constraints, how), late(constraints, how);
    usual.update(near, fast);
    late.update(unknown, fast);
    late.update(near, fast);
    CHECK(late.b()[0] == usual.b()[0]);
    CHECK(usual.b()[0] <= (level == DamperLevel::velocity ? -2 : 0));  // it does not act as it enters
    // What has entered keeps its gains while nothing is known.
    late.update(unknown, fast);
    late.update(near, 0 * fast);
    CHECK(late.damping(0) == usual.damping(0));
    CHECK(late.barrierGain(0) == usual.barrierGain(0));
  }
}

TEST_CASE("the acceleration's bound is a number: 0 where nothing changes, infinite where nothing bounds it") {
  const double none = std::numeric_limits<double>::infinity();
  CHECK(collisionAccelerationBound({}, 1, 0) == 0);  // no active row, and therefore no eigenvalue
  CHECK(collisionAccelerationBound({none, 0, 0, 0}, 1, 1) == 0);
  CHECK(collisionAccelerationBound({none, 2, 0, 0}, 1, 4) == 1);
  CHECK(collisionAccelerationBound({3, 2, 4, 1}, 4, 25) == 6 + 1);
  for (const double eigenvalue : {0.0, -1.0}) {
    CHECK(collisionAccelerationBound({1, 1, 1, 1}, eigenvalue, 1) == none);
    CHECK(collisionAccelerationBound({1, 1, 1, 1}, 1, eigenvalue) == none);
  }
  CHECK(collisionAccelerationBound({none, 1, 1, 1}, 1, 1) == none);
}

TEST_CASE("a configuration that is not a number meets no row, and leaves what has entered as it was") {
  Held held(0.01, 10, 0.08);
  const VectorXd still = 0 * held.q, none = VectorXd::Constant(held.q.size(), std::nan(""));
  VelocityDamper damper(*held.constraints, {});
  damper.update(held.q, still);
  REQUIRE(damper.near().empty());
  damper.update(none, still);
  REQUIRE(damper.near().size() == 1);
  CHECK(damper.b()[0] == std::numeric_limits<double>::infinity());
  CHECK(MatrixXd(damper.A()).norm() == 0);
  damper.update(held.q, still);
  // Moves towards the influence at 4 m/s: the row enters with headroom.
  const VectorXd gradient = MatrixXd(damper.A()).row(0);
  const VectorXd qd = -4 * gradient / gradient.squaredNorm();
  damper.update(none, qd);
  damper.update(held.q + 0.035 / 4 * qd, qd);
  REQUIRE(damper.near().size() == 1);
  CHECK((damper.A() * qd)[0] >= damper.b()[0]);
}
