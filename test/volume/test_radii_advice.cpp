// The bounds on what two shapes add to d'', and radii for a clearance and an acceleration. Both promises are
// measured, the acceleration by differences of distances.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/volume/covered_hull.h"
#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/radii_advice.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

Vector3d across(const Vector3d& v, const Vector3d& n) { return v - n.dot(v) * n; }
Vector3d inDisc(const Vector3d& n, double radius, Random& random) {
  return random.uniform(0, radius) * across(random.direction(), n).normalized();
}

/// A static body and one that moves. At most one of them is the box.
struct Pair {
  StpBv::Ptr still, moving;  // null for the box
  Shape box = Shape::boxOf({0.4, 0.3, 0.2});
  Isometry3d at = Isometry3d::Identity(), pose = Isometry3d::Identity();

  Distance ask(const Isometry3d& moved) const {
    if (!still) return distance(box, at, *moving, moved);
    return moving ? distance(*still, at, *moving, moved) : distance(*still, at, box, moved);
  }
  ContactAcceleration bound(double apart, double speed, double turning) const {
    return contactAcceleration(still ? still->radii() : kFlatRadii, moving ? moving->radii() : kFlatRadii,
                               apart, speed, turning);
  }
  double r() const { return (still ? still->radii().r : 0) + (moving ? moving->radii().r : 0); }

  /// Turns both randomly and puts the second one at this distance.
  void place(double apart, Random& random) {
    at.linear() = random.rotation();
    pose.linear() = random.rotation();
    pose.translation() = 3 * random.direction();
    for (int k = 0; k < 3; ++k) {  // along its own normal, a distance falls by exactly what the body moves
      const Distance d = ask(pose);
      pose.translation() += (apart - d.distance) * d.normal;
    }
  }
};

struct Motion {
  double apart, speed, turning;
  double added;  // c, as measured
};

/// The c of a random motion with at most these speeds, by second differences of the distance.
Motion measure(const Pair& pair, double speed, double turning, Random& random) {
  const Distance d = pair.ask(pair.pose);
  const Vector3d n = d.normal, y = inDisc(n, turning, random);
  const Vector3d u = inDisc(n, speed, random), w = n.cross(y) + random.uniform(-1, 1) * n;
  // Velocity of the point at the origin.
  const Vector3d v = u + random.uniform(-0.1, 0.1) * n - w.cross(d.point[1]);
  const double step = 2e-4 * (d.distance + pair.r()) / (0.1 + speed + 0.1 * turning);
  const auto after = [&](double t) {
    // x(t) = x + v t + w x v t^2 / 2 + ...: a screw to the second order, the rest is t^3
    Isometry3d moved = pair.pose;
    const Eigen::AngleAxisd turn(t * w.norm(), w.normalized());
    moved.linear() = turn * pair.pose.linear();
    moved.translation() = turn * pair.pose.translation() + t * v + 0.5 * t * t * w.cross(v);
    return pair.ask(moved).distance;
  };
  const double bent = (after(step) - 2 * after(0) + after(-step)) / (step * step);
  const double material = n.dot(w.cross(v + w.cross(d.point[1])));
  return {d.distance, u.norm(), y.norm(), bent - material};
}

Cloud randomCloud(Random& random) {
  const Vector3d half(random.uniform(0.01, 0.2), random.uniform(0.01, 0.2), random.uniform(0.001, 0.2));
  if (random.below(3) == 0) return box(2 * half.x(), 2 * half.y(), 2 * half.z());
  return randomHull(4 + random.below(60), half, static_cast<std::uint64_t>(random.below(100000)));
}

// Rounding of a second difference, which has four distances in all. Each may be off by 40 epsilon, below
// 1e-14, of the bodies' size, which is below 1 m (kGapRounding in relative_pose.h).
double noiseOf(const Pair& pair, const Motion& m) {
  const double s = m.apart + pair.r(), step = 2e-4 * s / (0.1 + m.speed + 0.1 * m.turning);
  return 4e-14 / (step * step);
}

}  // namespace

TEST_CASE("no motion bends the distance more than the radii, the distance and the speeds allow") {
  Random random(11);
  double most = 0, least = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    Pair pair;
    const auto volume = [&] {
      const Cloud cloud = randomCloud(random);
      const double r = random.uniform(0.005, 0.05);
      return StpBv::build(cloud, {r, StpBv::smallestR(cloud, r) * random.uniform(1.01, 20)});
    };
    const int flat = random.below(3);
    if (flat != 0) pair.still = volume();
    if (flat != 1) pair.moving = volume();
    pair.place(random.uniform(0, 0.05), random);
    const double speed = random.below(4) == 0 ? 0 : random.uniform(0, 1),
                 turning = random.below(4) == 0 ? 0 : random.uniform(0, 2);
    const Motion m = measure(pair, speed, turning, random);
    const ContactAcceleration bound = pair.bound(m.apart, m.speed, m.turning);
    // The speeds change by a few 1e-4 of themselves over the step.
    const double slack = noiseOf(pair, m) + 1e-3 * (bound.most + std::min(-bound.least, 1.0));
    CHECK(m.added <= bound.most + slack);
    CHECK(m.added >= bound.least - slack);
    if (bound.most > 100 * slack) most = std::max(most, m.added / bound.most);
    if (bound.least < -100 * slack) least = std::max(least, m.added / bound.least);
  }
  CHECK(most > 0.9);  // a bound that is never approached would show nothing
  CHECK(least > 0.5);
}

TEST_CASE("two balls that slide, and a big face that rocks over a plane, reach the bounds") {
  Random random(3);
  Pair balls{StpBv::build({{0, 0, 0}}, {0.01, 1}), StpBv::build({{0, 0, 0}}, {0.02, 1})}, face;
  balls.place(0.03, random);
  const Motion slid = measure(balls, 0.5, 0, random);
  CHECK(slid.added == Approx(balls.bound(0.03, slid.speed, 0).most).epsilon(1e-4));  // of the differences
  face.moving = StpBv::build(box(0.2, 0.2, 0.2), {0.01, 2});
  face.pose.translation().z() = 0.1 + 0.02 + face.moving->support({0, 0, -1});
  const Motion rocked = measure(face, 0, 1, random);
  CHECK(rocked.added == Approx(face.bound(rocked.apart, 0, rocked.turning).least).epsilon(1e-4));
  const Radii small{0.01, 1, 0.99}, big{0.02, 5, 4.98};
  CHECK(contactAcceleration(small, big, 0.03, 0.3, 0).most == Approx(0.3 * 0.3 / 0.06));
  CHECK(contactAcceleration(small, big, 0.03, 0.3, 0).least == 0);
  CHECK(contactAcceleration(kFlatRadii, small, 0, 0, 2).least == -4);
  CHECK(contactAcceleration(kFlatRadii, small, 0, 0, 2).most == 0);
  CHECK_FALSE(std::signbit(contactAcceleration(kFlatRadii, small, 0.01, 0, 0).size()));
  for (const double r : {0.0, 0.01, 1e8})  // where the normal follows the slide, r has no influence
    CHECK(contactAcceleration(kFlatRadii, {r, 1e8, 1e8 - r}, 0.1, 0.067, 1.3).most == 0.067 * 0.067 / 0.1);
  constexpr double kNone = std::numeric_limits<double>::infinity();
  CHECK(contactAcceleration(kFlatRadii, kFlatRadii, 0, 1, 1).size() == kNone);
  // Spheres of the radii r that meet at their centres: turning alone is enough, unless the radius is 0.
  const Radii quarter{0.25, 1, 0.75}, half{0.5, 1, 0.5}, sharp{0, 1, 1};
  for (const double below : {0.0, 1e-3}) {
    CHECK(contactAcceleration(quarter, half, -0.75 - below, 0, 1).most == kNone);
    CHECK(contactAcceleration(quarter, half, -0.75 - below, 1, 0).most == kNone);
    CHECK(contactAcceleration(quarter, half, -0.75 - below, 0, 0).most == 0);
  }
  CHECK(contactAcceleration(quarter, sharp, -0.25, 0, 1).most == 0);
  CHECK(contactAcceleration(quarter, sharp, -0.25 + 1e-9, 0, 1).most == 0);
  CHECK(contactAcceleration(quarter, half, -0.75 + 1e-9, 0, 1).most > 1e8);
}

TEST_CASE("advised radii keep the stated clearance and the allowed acceleration, on any body") {
  Random random(5);
  int kept = 0, impossible = 0, refused = 0;
  double tightest = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Cloud cloud = randomCloud(random);
    RadiiTask task;
    task.clearance = std::pow(10, random.uniform(-3.5, -1.5));
    task.acceleration = std::pow(10, random.uniform(-1, 1.5));
    task.speed = random.uniform(0, 0.5);
    task.turning = random.uniform(0, 2);
    task.distance = random.below(2) == 0 ? 0 : 0.01;
    task.bothRound = random.below(2) == 0;
    RadiiAdvice advice;
    try {
      advice = adviseRadii(cloud, task);
    } catch (const Error&) {  // a corner so sharp that rows miss the whole clearance in a period
      ++refused;
      continue;
    }
    const StpBv::Ptr volume = StpBv::build(cloud, advice.radii);
    CHECK(overCover(*volume, cloud).max == advice.overCover);
    CHECK(advice.overCover <= task.clearance);
    ++(advice.meetsBoth ? kept : impossible);
    if (advice.meetsBoth) {
      CHECK(advice.acceleration <= task.acceleration);
      CHECK(advice.overCover + advice.perPeriod <= task.clearance);
      // A smaller R would lose too much clearance, or has no volume.
      const StpBvOptions rounder{advice.radii.r, 0.998 * advice.radii.R};
      if (rounder.R > StpBv::smallestR(cloud, rounder.r))
        CHECK(overCover(*StpBv::build(cloud, rounder), cloud).max + 1e-6 * task.acceleration >
              task.clearance);
    }
    Pair pair;
    pair.moving = volume;
    if (task.bothRound) pair.still = volume;
    for (int k = 0; k < 40; ++k) {
      pair.place(task.distance + random.uniform(1e-3, 0.02), random);
      const Motion m = measure(pair, task.speed, task.turning, random);
      const double slack = noiseOf(pair, m) + 1e-3 * advice.acceleration;
      if (slack > 0.1 * advice.acceleration) continue;  // too sharp for differences
      CHECK(std::abs(m.added) <= advice.acceleration + slack);
      tightest = std::max(tightest, std::abs(m.added) / advice.acceleration);
    }
  }
  CHECK(kept > 10);
  CHECK(impossible > 10);
  CHECK(refused < 5);
  CHECK(tightest > 0.5);
}

TEST_CASE("the clearance holds what a long period's rows miss, also with more acceleration than stated") {
  Random random(6);
  int advised = 0, more = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Cloud cloud = randomCloud(random);
    RadiiTask task;
    task.clearance = std::pow(10, random.uniform(-3, -1.5));
    task.period = std::pow(10, random.uniform(-2.5, -1.2));
    task.speed = random.uniform(0, 0.5);
    task.turning = random.uniform(0, 2);
    try {
      const RadiiAdvice advice = adviseRadii(cloud, task);
      ++advised;
      more += !advice.meetsBoth;
      CHECK(advice.overCover + advice.perPeriod <= task.clearance);
    } catch (const Error& error) {
      CHECK_THAT(error.what(), Catch::Matchers::Contains("found no r and R that keep a clearance"));
    }
  }
  CHECK(advised > 20);
  CHECK(more > 5);
}

TEST_CASE("a long period makes R smaller, and refuses nothing that some radii keep") {
  Random random(9);
  int advised = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const Cloud cloud =
        trial % 6 == 0 ? Cloud{{1, 2, 3}} : box(random.uniform(0.02, 0.4), random.uniform(0.02, 0.4), 0.02);
    RadiiTask task;
    task.clearance = std::pow(10, random.uniform(-3, -1.5));
    task.acceleration = std::pow(10, random.uniform(-2, 1));
    task.period = std::pow(10, random.uniform(-2.5, -0.5));
    task.speed = random.uniform(0, 5);
    task.turning = trial % 4 == 0 ? 0 : std::pow(10, random.uniform(-2.5, 0.5));
    // The least acceleration of radii that keep the clearance, on a grid.
    double least = std::numeric_limits<double>::infinity();
    const double smallest = StpBv::smallestR(cloud, 0);
    const detail::CoveredHull hull(cloud);
    for (double r = 1e-3 * task.clearance; r < task.clearance; r *= 1.4)
      for (double R = 1.01 * (smallest + r); R < 1e6; R *= 1.7) {
        const double over = hull.max(*StpBv::build(cloud, {r, R}));
        const ContactAcceleration c =
            contactAcceleration(kFlatRadii, {r, R, R - r}, 0, task.speed, task.turning);
        if (over - 0.5 * c.least * task.period * task.period <= task.clearance)
          least = std::min(least, c.size());
      }
    INFO("trial " << trial << ", least " << least);
    if (std::isinf(least)) continue;
    const RadiiAdvice advice = adviseRadii(cloud, task);
    ++advised;
    CHECK(advice.overCover + advice.perPeriod <= task.clearance);
    CHECK(advice.acceleration <= std::max(task.acceleration, 1.2 * 1.01 * least));
    CHECK(advice.meetsBoth == (advice.acceleration <= task.acceleration));
  }
  CHECK(advised > 15);
}

TEST_CASE(
    "where no radii keep both promises the advice is within a fifth of the least acceleration, at the "
    "smallest R") {
  Random random(8);
  RadiiTask task{0.003, 0.2, 0.3, 1.0, 0};  // a period would use a part of the clearance
  for (int trial = 0; trial < 8; ++trial) {
    const Cloud cloud = box(random.uniform(0.1, 0.4), random.uniform(0.1, 0.4), random.uniform(0.02, 0.2));
    task.bothRound = trial % 2 == 0;
    const RadiiAdvice advice = adviseRadii(cloud, task);
    REQUIRE_FALSE(advice.meetsBoth);
    RadiiTask other = task;
    other.acceleration = 1.002 * advice.acceleration;
    CHECK(adviseRadii(cloud, other).meetsBoth);
    other.acceleration = 0.998 * advice.acceleration / 1.2;  // the search ends within a thousandth
    CHECK_FALSE(adviseRadii(cloud, other).meetsBoth);
    CHECK(advice.overCover <= task.clearance);
    const StpBvOptions rounder{advice.radii.r, 0.998 * advice.radii.R};
    if (rounder.R > StpBv::smallestR(cloud, rounder.r))
      CHECK(overCover(*StpBv::build(cloud, rounder), cloud).max > task.clearance);
    if (std::isinf(advice.leastClearance)) continue;
    other = task;
    other.clearance = advice.leastClearance;
    CHECK(adviseRadii(cloud, other).meetsBoth);
    other.clearance = advice.leastClearance * (1 - 1e-12);
    CHECK_FALSE(adviseRadii(cloud, other).meetsBoth);
  }
  task.period = 1;  // half of R is missed within it
  CHECK_THROWS_WITH(adviseRadii(box(0.1, 0.1, 0.1), task), Catch::Contains("shorter period"));
  task.period = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(adviseRadii(box(0.1, 0.1, 0.1), task), Catch::Contains("period"));
  CHECK_THROWS_AS(adviseRadii({}, RadiiTask()), Error);
}

TEST_CASE("the acceleration that an advice names is kept when it is asked for") {
  RadiiTask task;
  task.clearance = 0.022;
  task.acceleration = 0.014;
  task.speed = 0.067;
  task.turning = 1.3;
  task.distance = 0.1;
  const Cloud cloud = box(0.005, 0.004, 0.003);
  const RadiiAdvice advice = adviseRadii(cloud, task);
  REQUIRE_FALSE(advice.meetsBoth);
  task.acceleration = advice.acceleration;
  CHECK(adviseRadii(cloud, task).meetsBoth);
}

TEST_CASE("a body that does not turn gets the smallest R that the clearance takes, however small it is") {
  for (const double size : {1e-4, 1e-3, 1e-2, 0.1, 1.0}) {
    const Cloud cloud = box(size, 0.7 * size, 0.4 * size);
    RadiiTask task;
    task.clearance = 0.1 * size;
    task.acceleration = 1e4;
    task.speed = 1e-2;
    task.turning = 0;
    const RadiiAdvice advice = adviseRadii(cloud, task);
    CAPTURE(size, advice.radii.r, advice.radii.R);
    CHECK(advice.meetsBoth);
    CHECK(advice.overCover <= task.clearance);
    CHECK(overCover(*StpBv::build(cloud, {advice.radii.r, 0.998 * advice.radii.R}), cloud).max >
          task.clearance);
  }
  const RadiiAdvice point = adviseRadii({{1, 2, 3}}, RadiiTask{0.01, 1, 0.01, 0});
  CHECK(point.meetsBoth);
  CHECK(point.radii.R < 1.01 * point.radii.r);
  // A point without a margin may have any R. No robot needs a smaller one than this.
  const RadiiAdvice sharp = adviseRadii({{1, 2, 3}}, RadiiTask{1e-3, 2, 0.3, 1, 1e-3, 0.02});
  CHECK(sharp.radii.r == 0);
  CHECK(sharp.radii.R == Approx(1e-9).epsilon(0.01));
}
