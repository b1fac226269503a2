// How rows enter at every level of the velocity damper. No sampled pair may pass its security distance.
#include <fcl/geometry/shape/box.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <utility>

#include "fcl_stpbv/robot/velocity_damper.h"
#include "test/reference/robots.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kTick = 1e-3, kSecurity = 0.01, kReach = 0.04;

/// A box on a rail moves towards a wall. Its distance is the remaining way of the coordinate.
struct Rail {
  std::unique_ptr<CollisionConstraints> constraints;
  double touch = 0;

  explicit Rail(ConstraintOptions options = {}) {
    const char* const text = R"(<robot name="rail"><link name="base"/><link name="slide"/>
      <joint name="x" type="prismatic"><parent link="base"/><child link="slide"/><axis xyz="1 0 0"/>
        <limit lower="-9" upper="9" effort="1" velocity="1"/></joint></robot>)";
    const auto model = std::make_shared<const RobotModel>(parseUrdf(text, "rail.urdf"));
    const Body box =
        smoothBody(model->link("slide"), "box", StpBv::build(test::box(0.2, 0.2, 0.2), {0.01, 10}));
    const fcl::CollisionObjectd wall(std::make_shared<fcl::Boxd>(0.5, 0.4, 0.4), Eigen::Matrix3d::Identity(),
                                     Vector3d(1, 0, 0));
    constraints = singleRow(std::make_shared<const Kinematics>(model), box, wall, std::move(options));
    VectorXd d(1);
    constraints->evaluate(VectorXd::Zero(1), d);
    touch = d[0];
  }

  /// Updates with the pair `room` above its security distance, approaching at `speed`.
  void update(VelocityDamper& damper, double room, double speed) const {
    damper.update(VectorXd::Constant(1, touch - kSecurity - room), VectorXd::Constant(1, speed));
  }
};

/// The largest velocity or acceleration that a row allows, at most `wanted`: J = -1.
double allowed(const VelocityDamper& damper, double wanted) {
  return damper.near().empty() ? wanted : std::min(wanted, -damper.b()[0]);
}

DamperOptions at(DamperLevel level) {
  DamperOptions options;
  options.level = level;
  return options;
}

}  // namespace

TEST_CASE("a pair that is no faster than its damper allows keeps its xi, however near it is when it enters") {
  const Rail rail;
  for (const double room : {1e-2, 1e-3, 1e-5, 1e-6, 1e-8}) {
    VelocityDamper damper(*rail.constraints, {});
    double before = 0, d = 0;
    for (int tick = 0; tick < 2000; ++tick) {
      const VectorXd q = VectorXd::Constant(1, tick == 0 ? rail.touch - kSecurity - room : d);
      damper.update(q, VectorXd::Constant(1, before));
      const double now = allowed(damper, 0.2);
      CHECK(damper.d()[0] >= kSecurity - 1e-12);  // to rounding
      // The box never moves back. After the first tick it is only braked, at a rate of 0.5 / 0.04 per second.
      CHECK(now >= 0);
      if (tick > 0) CHECK(std::abs(now - before) <= 12.5 * 0.2 * kTick * (1 + 1e-6));
      before = now;
      d = q[0] + kTick * now;
    }
    CHECK(damper.damping(0) == 0.5);
  }
}

TEST_CASE("a row asks for what its damper allowed when the damper is made anew at any place of its way") {
  const Rail rail;
  for (const double room : {0.03, 1e-3, 1e-5, 1e-9})
    for (const double part : {0.5, 0.99, 1.0, 1.001}) {
      VelocityDamper damper(*rail.constraints, {});
      const double own = 0.5 / kReach * room;
      rail.update(damper, room, part * own);
      // Twice the excess, plus the rounding of the distance.
      CHECK(allowed(damper, 9) <= own * std::max(1.0, 2 * part - 1) + 1e-13);
      CHECK(allowed(damper, 9) >= own - 1e-13);
    }
}

TEST_CASE("no row acts on the tick on which it enters where its pair is some periods away, at any level") {
  const Rail rail;
  for (const DamperLevel level : {DamperLevel::velocity, DamperLevel::acceleration, DamperLevel::barrier})
    for (const double g : {5.0, 50.0})
      for (const double room : {0.0399, 0.02, 1e-3, 1e-5})
        for (const double speed : {0.0, 1e-4, 0.3, 0.42, 0.46, 0.5, 1.0, 2.0, 5.0, 20.0, 300.0}) {
          DamperOptions options = at(level);
          options.barrierGain = g;
          VelocityDamper damper(*rail.constraints, options);
          rail.update(damper, room, speed);
          REQUIRE(damper.near().size() == 1);
          const bool velocity = level == DamperLevel::velocity, both = level == DamperLevel::barrier;
          const double periods = velocity ? 1 : both ? 6 : 3;
          const double slack = allowed(damper, 1e9) - (velocity ? speed : 0);
          CAPTURE(static_cast<int>(level), g, room, speed, slack, damper.damping(0), damper.barrierGain(0));
          const double away = room / (periods * kTick * speed);
          if (away > 1.001) CHECK(slack >= 0);
          if (away < 0.999) CHECK(slack < 0);
          const double a = damper.damping(0) / kReach, gain = damper.barrierGain(0);
          CHECK(a >= 12.5);
          CHECK(gain >= g);
          CHECK(std::max(a, both ? gain : 0) <= (velocity ? 1 : 1.0 / 3) / kTick * (1 + 1e-12));
          // For a barrier: the state is inside its set, so the row keeps the pair from its security distance.
          if (both && away > 1.001) CHECK(a * room >= speed);
          if (speed == 0) CHECK(a == Approx(12.5).epsilon(1e-15));
          if (!both || speed == 0) CHECK(gain == g);
          damper.update(VectorXd::Constant(1, rail.touch - 1), VectorXd::Zero(1));
          rail.update(damper, room, 0);
          CHECK(damper.damping(0) == 0.5);  // the pair has left the influence
          CHECK(damper.barrierGain(0) == g);
        }
}

TEST_CASE(
    "whatever gains are given, a barrier does not act as its pair enters, and its state is inside its set") {
  const Rail rail;
  for (const double large : {0.01, 0.2, 1.0 / 3, 0.4, 0.5, 0.6, 0.66, 0.7, 0.78, 0.8, 0.9, 0.97, 0.99, 1.0})
    for (const double small : {1e-4, 0.0125, 0.1, 0.3})
      for (const bool mirrored : {false, true})
        for (const double room : {0.0399, 1e-3})
          for (const double periods : {6.001, 8.0, 20.0, 40.0, 67.0, 1000.0})
            for (const double headroom : {0.0, 0.05}) {
              DamperOptions options = at(DamperLevel::barrier);
              options.headroom = headroom;
              options.all.damping = (mirrored ? large : small) / kTick * kReach;
              options.barrierGain = (mirrored ? small : large) / kTick;
              VelocityDamper damper(*rail.constraints, options);
              double left = room, speed = room / (periods * kTick), least = room;
              rail.update(damper, left, speed);
              const double a = damper.damping(0) / kReach, g = damper.barrierGain(0);
              CAPTURE(large, small, mirrored, room, periods, headroom, a * kTick, g * kTick, damper.b()[0]);
              // The rounding of the sums and of the room, which is the distance less d_s.
              CHECK(damper.b()[0] <= 1e-12 * (a + g) * speed + 1e-15 * a * g);
              CHECK(a * room >= speed);
              CHECK((a + g) * kTick <= 1 + 1e-12);
              const bool exact = mirrored;
              for (int tick = 0; tick < 100; ++tick) {
                const double next = speed + kTick * allowed(damper, 1e4);
                left -= kTick * (exact ? (speed + next) / 2 : next);
                speed = next;
                least = std::min(least, left);
                rail.update(damper, left, speed);
              }
              CHECK(least >= -1e-12);  // rounding
            }
}

TEST_CASE("a pair that enters at any speed that leaves it time does not pass its security distance") {
  const Rail rail;
  for (const DamperLevel level : {DamperLevel::velocity, DamperLevel::acceleration, DamperLevel::barrier})
    for (const bool exact : {false, true})
      for (const double room : {0.0399, 1e-3, 1e-5})
        for (const double periods : {1.05, 3.05, 6.05, 7.0, 12.0, 100.0, 1000.0}) {
          const bool velocity = level == DamperLevel::velocity;
          if (periods < (velocity ? 1 : level == DamperLevel::acceleration ? 3 : 6)) continue;
          VelocityDamper damper(*rail.constraints, at(level));
          double left = room, speed = room / (periods * kTick), least = room;
          for (int tick = 0; tick < 300; ++tick) {
            rail.update(damper, left, speed);
            // It moves towards the wall as fast as the row allows.
            const double x = allowed(damper, velocity ? 1 + speed : 1e4);
            const double next = velocity ? x : speed + kTick * x;
            left -= kTick * (exact && !velocity ? (speed + next) / 2 : next);
            speed = next;
            least = std::min(least, left);
          }
          CAPTURE(static_cast<int>(level), exact, room, periods);
          CHECK(least >= -1e-12);  // rounding
        }
}

TEST_CASE("no pair passes its security distance with any gains, at periods of 1 ms to 0.5 s") {
  const Rail rail;
  std::mt19937 random(1);
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  for (const double period : {1e-3, 3e-3, 0.01, 0.02, 0.03, 0.05, 0.08, 0.1, 0.2, 0.5})
    for (const DamperLevel level : {DamperLevel::velocity, DamperLevel::acceleration, DamperLevel::barrier})
      for (const bool exact : {false, true})
        for (int trial = 0; trial < 40; ++trial) {
          const bool velocity = level == DamperLevel::velocity;
          DamperOptions options = at(level);
          options.period = period;
          if (trial % 4) {  // otherwise the gains that nobody has chosen
            options.all.damping = kReach / period * std::pow(10, uniform(-3, 1));
            options.barrierGain = std::pow(10, uniform(-3, 1)) / period;
          }
          if (trial % 3 == 0) options.headroom = 0;
          VelocityDamper damper(*rail.constraints, options);
          // Outside the influence a pair goes at most the way of the influence per tick.
          const double most = kReach / period * std::pow(10, uniform(-2, 0));
          double left = kReach + uniform(0, 1) * period * most, speed = most, least = 0, expected = 0;
          bool near = false;
          for (int tick = 0; tick < 60; ++tick) {
            rail.update(damper, left, speed);
            // An exact acceleration can stop a pair only on half of the tick's way.
            if (exact && !velocity && !near && !damper.near().empty())
              expected = std::min(expected, left - period * speed / 2);
            near = !damper.near().empty();
            const double wanted = uniform(0, 1) < 0.6 ? most : uniform(-0.3, 1) * most;
            const double next = velocity ? allowed(damper, wanted)
                                         : speed + period * allowed(damper, (wanted - speed) / period);
            left -= period * (exact && !velocity ? (speed + next) / 2 : next);
            speed = next;
            least = std::min(least, left);
          }
          CAPTURE(period, static_cast<int>(level), exact, trial, options.all.damping, options.barrierGain,
                  most);
          CHECK(least >= expected - 1e-12);  // rounding
        }
}

TEST_CASE("gains that the period makes too large are limited, all others stay as they are given") {
  const Rail rail;
  const auto gains = [&](DamperLevel level, double period, double a, double g) {
    DamperOptions options = at(level);
    options.period = period;
    options.all.damping = a * kReach;
    options.barrierGain = g;
    const VelocityDamper damper(*rail.constraints, options);
    if (damper.damping(0) == options.all.damping) return std::pair(a, damper.barrierGain(0));
    return std::pair(damper.damping(0) / kReach, damper.barrierGain(0));
  };
  const auto check = [](std::pair<double, double> got, double a, double g) {
    CHECK(got.first == Approx(a).epsilon(1e-14));
    CHECK(got.second == Approx(g).epsilon(1e-14));
  };
  const DamperLevel velocity = DamperLevel::velocity, acceleration = DamperLevel::acceleration,
                    barrier = DamperLevel::barrier;
  check(gains(velocity, 0.1, 12.5, 50), 10, 50);
  check(gains(acceleration, 0.1, 12.5, 50), 10.0 / 3, 50);
  check(gains(barrier, 0.02, 12.5, 50), 12.5, 37.5);  // the larger one first
  check(gains(barrier, 0.02, 50, 12.5), 37.5, 12.5);
  check(gains(barrier, 0.1, 12.5, 50), 5, 5);  // then both
  CHECK(gains(velocity, 0.1, 9.9, 50) == std::pair(9.9, 50.0));
  CHECK(gains(acceleration, 0.1, 3.3, 50) == std::pair(3.3, 50.0));
  CHECK(gains(barrier, 0.1, 1.7, 8.2) == std::pair(1.7, 8.2));
}

TEST_CASE("a damper on rows that bend over brakes as one on rows that do not") {
  for (const DamperLevel level : {DamperLevel::velocity, DamperLevel::acceleration, DamperLevel::barrier})
    for (const double start : {0.5, 3.0}) {
      const auto peak = [&](const Rail& rail) {
        DamperOptions options = at(level);
        options.all.influence = rail.constraints->exactUpTo(0) < 1 ? rail.constraints->exactUpTo(0) : 0.05;
        VelocityDamper damper(*rail.constraints, options);
        double left = 0.2, speed = start, most = 0;
        for (int tick = 0; tick < 400; ++tick) {
          rail.update(damper, left, speed);
          const double x = allowed(damper, level == DamperLevel::velocity ? start : (start - speed) / kTick);
          const double next = level == DamperLevel::velocity ? x : speed + kTick * x;
          most = std::max(most, std::abs(next - speed) / kTick);
          left -= kTick * next;
          speed = next;
        }
        CHECK(left >= -1e-12);
        return most;
      };
      ConstraintOptions bends;
      bends.influence = 0.1;
      const Rail straight;
      Rail bent(bends);
      bent.touch = straight.touch;  // where the row is constant at 0
      CHECK(peak(bent) == Approx(peak(straight)).epsilon(1e-9));
    }
}

TEST_CASE("an influence at the end of where a row is exact is taken, however it is rounded or written") {
  int above = 0;  // decimals that are larger than the value by rounding
  for (int cm = 1; cm < 60; ++cm)
    for (const double share : {0.5, 0.3, 0.7}) {  // shares of the influence up to which a row is exact
      ConstraintOptions reach;
      reach.influence = cm / 100.0;
      reach.exactUpTo = share * reach.influence;
      const Rail rail(reach);
      const double most = rail.constraints->exactUpTo(0), written = cm * 100 * share / 1e4;
      for (const double influence : {most, written}) {
        DamperOptions options;
        options.all = {influence, -0.01, 0.5};
        VelocityDamper damper(*rail.constraints, options);
        damper.update(VectorXd::Constant(1, -1), VectorXd::Ones(1));
        CAPTURE(cm, share, influence, most, damper.d()[0]);
        CHECK(damper.near().empty());
        above += influence > most;
      }
    }
  CHECK(above > 0);
}

TEST_CASE("a tick without a velocity uses up no entry") {
  const Rail rail;
  for (const DamperLevel level : {DamperLevel::velocity, DamperLevel::acceleration, DamperLevel::barrier}) {
    VelocityDamper damper(*rail.constraints, at(level));
    rail.update(damper, 0.039, std::nan(""));
    CHECK(std::isinf(damper.b()[0]));
    CHECK(damper.A().norm() == 0);
    rail.update(damper, 0.039, 1.5);
    VelocityDamper fresh(*rail.constraints, at(level));
    rail.update(fresh, 0.039, 1.5);
    CHECK(damper.b()[0] == fresh.b()[0]);
  }
}

TEST_CASE(
    "a pair whose rows turn within a tick comes below its security distance by what docs/control.md says") {
  // A ball on an arm of 0.3 m turns in front of a wall, towards which the rail pushes it. At angle 0 its
  // distance is largest and falls with the square of the angle, which a velocity row does not know.
  const char* const text = R"(<robot name="arm"><link name="base"/><link name="slide"/><link name="ball"/>
    <joint name="x" type="prismatic"><parent link="base"/><child link="slide"/><axis xyz="1 0 0"/>
      <limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
    <joint name="turn" type="continuous"><parent link="slide"/><child link="ball"/><axis xyz="0 0 1"/></joint></robot>)";
  constexpr double kArm = 0.3, kTurn = 2;
  const auto model = std::make_shared<const RobotModel>(parseUrdf(text, "arm.urdf"));
  const Body ball = smoothBody(model->link("ball"), "ball", StpBv::build({{-kArm, 0, 0}}, {0.05, 1}));
  const fcl::CollisionObjectd wall(std::make_shared<fcl::Boxd>(0.5, 4, 4), Eigen::Matrix3d::Identity(),
                                   Vector3d(1, 0, 0));
  const auto constraints = singleRow(std::make_shared<const Kinematics>(model), ball, wall);
  DamperOptions options;
  options.all.damping = 2;
  VelocityDamper damper(*constraints, options);
  VectorXd q(2), qd = VectorXd::Zero(2), wanted(2);
  q << 0.6, -1.2;
  wanted << 2, kTurn;
  const double drift = kArm * kTurn * kTurn, gain = 2 / kReach, most = kTick * drift / (2 * gain);
  double least = 1;
  for (; q[1] < 1.2; q += kTick * qd) {
    damper.update(q, qd);
    const VectorXd a = MatrixXd(damper.A()).row(0);
    qd = wanted;
    // Only the rail gives way.
    if (!damper.near().empty()) qd[0] = std::min(qd[0], (damper.b()[0] - a[1] * qd[1]) / a[0]);
    least = std::min(least, damper.d()[0] - kSecurity);
  }
  CHECK(least < -0.5 * most);
  CHECK(least > -1.05 * most);
}
