// The distance is C1: its gradient equals the differences, and the normal turns no faster than theory allows.
#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/distance/distance.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

Isometry3d turned(const Isometry3d& p, const Vector3d& axis, double angle) {
  return pose(Eigen::AngleAxisd(angle, axis).toRotationMatrix() * p.linear(), p.translation());
}

/// Slides `b` by steps of `length` and checks every turn of the normal against docs/theory.md, 6.
void sweep(const StpBv& a, const Isometry3d& poseA, const StpBv& b, Isometry3d poseB,
           const Vector3d& direction, double length, int steps) {
  // A normal is accurate to the rounding of the core points (8 ulps of both radii) divided by the weakest
  // curvature.
  const double margins = a.radii().r + b.radii().r;
  const Vector3d start = poseB.translation();
  PairCache cache;
  Distance last = distance(a, poseA, b, poseB, &cache);
  double worst = 0;
  for (int i = 1; i <= steps; ++i) {
    poseB.translation() = start + i * length * direction;
    const Distance d = distance(a, poseA, b, poseB, &cache);
    if (d.status == DistanceStatus::local) {  // a bulging body moved too deep
      REQUIRE(d.distance <= 1e-12 - margins);
      break;
    }
    REQUIRE(d.status == DistanceStatus::exact);
    const double core = std::min(d.distance, last.distance) + margins;
    const double rounding = 2 * 8 * 2.2e-16 * (a.radii().R + b.radii().R + 2) / core;
    const double turn = 2 * std::asin(std::min(1.0, 0.5 * (d.normal - last.normal).norm()));
    worst = std::max(worst, (turn - rounding) * core / length);
    last = d;
  }
  CHECK(worst <= 1.0);
}

}  // namespace

TEST_CASE("The gradient with respect to both bodies' twists is what central differences say") {
  const double R = GENERATE(1.0, 10.0, 100.0);
  const std::vector<StpBv::Ptr> pool{StpBv::build(box(0.3, 0.2, 0.5), {0.01, R}),
                                     StpBv::build(cylinder(0.15, 0.4), {0.02, R}),
                                     StpBv::build(randomHull(60, {0.2, 0.3, 0.1}, 4), {0.01, R}),
                                     StpBv::build({Vector3d(0, 0, -0.2), Vector3d(0.1, 0, 0.2)}, {0.01, R})};
  Random random(5);
  // Across a boundary the gradient is only Lipschitz, so the error is about step / core.
  constexpr double kStep = 1e-8;
  double worst = 0;
  for (int i = 0; i < 200; ++i) {
    const StpBv& a = *pool[static_cast<std::size_t>(random.below(4))];
    const StpBv& b = *pool[static_cast<std::size_t>(random.below(4))];
    const Isometry3d poseA = pose(random.rotation(), 0.5 * random.direction());
    Isometry3d poseB = pose(random.rotation(), 2.0 * random.direction());
    const Distance far = distance(a, poseA, b, poseB);
    const double target = random.below(2) ? -0.01 : 0.2;  // separated, and slightly penetrating
    poseB.translation() += (target - far.distance) * far.normal;
    const Distance d = distance(a, poseA, b, poseB);
    REQUIRE(d.status == DistanceStatus::exact);
    for (int body = 0; body < 2; ++body) {
      const Isometry3d& moved = body == 0 ? poseA : poseB;
      const TwistGradient gradient = d.gradient(body, moved.translation());
      for (int k = 0; k < 6; ++k) {
        double value[2];
        for (int side = 0; side < 2; ++side) {
          const double step = side ? kStep : -kStep;
          Isometry3d there = moved;
          if (k < 3)
            there.translation()[k] += step;
          else
            there = turned(moved, Vector3d::Unit(k - 3), step);
          value[side] = distance(a, body == 0 ? there : poseA, b, body == 1 ? there : poseB).distance;
        }
        worst = std::max(worst, std::abs((value[1] - value[0]) / (2 * kStep) - gradient[k]));
      }
    }
  }
  CHECK(worst < 1e-6);
}

TEST_CASE("The normal never turns faster than the step over the distance plus both margins") {
  const double R = GENERATE(1.0, 10.0, 100.0);
  const double gap = GENERATE(-0.015, 1e-3, 0.05);
  const double step = GENERATE(1e-3, 1e-5, 1e-7);
  const double r = 0.01;
  const StpBv::Ptr cube = StpBv::build(box(0.2, 0.2, 0.2), {r, R}),
                   flat = StpBv::build(plate(0.5, 0.5), {r, R}),
                   ball = StpBv::build(geodesicSphere(0.2, 2), {r, R});
  const Isometry3d origin = Isometry3d::Identity();
  // Places `b` at `gap` above the cube along z, with its origin at the given lateral position.
  const auto above = [&](const StpBv& b, const Matrix3d& rotation, const Vector3d& lateral) {
    Isometry3d p = pose(rotation, lateral + Vector3d(0, 0, 1));
    const Distance d = distance(*cube, origin, b, p);
    p.translation() += (gap - d.distance) * d.normal;
    return p;
  };
  const int steps = 400;
  const Vector3d half = Vector3d(0.5, 0.1, 0).normalized() * step * steps / 2;
  const Vector3d along = half.normalized();

  SECTION("a face over a face") {
    sweep(*cube, origin, *flat, above(*flat, Matrix3d::Identity(), -half), along, step, steps);
  }
  SECTION("a face's rim over a face's rim") {
    sweep(*cube, origin, *cube, above(*cube, Matrix3d::Identity(), Vector3d(0.2, 0, 0) - half), along, step,
          steps);
  }
  SECTION("an edge parallel to a face, over its rim") {
    const Matrix3d onEdge = Eigen::AngleAxisd(M_PI / 4, Vector3d::UnitY()).toRotationMatrix();
    sweep(*cube, origin, *cube, above(*cube, onEdge, Vector3d(0.1, 0, 0) - half), along, step, steps);
  }
  SECTION("an edge parallel to an edge") {
    const Matrix3d onEdge = Eigen::AngleAxisd(M_PI / 4, Vector3d::UnitY()).toRotationMatrix();
    const Isometry3d both = pose(onEdge, Vector3d(0, 0, 0));
    Isometry3d p = pose(onEdge, Vector3d(0, 0, 1) - half);
    const Distance d = distance(*cube, both, *cube, p);
    p.translation() += (gap - d.distance) * d.normal;
    sweep(*cube, both, *cube, p, along, step, steps);
  }
  SECTION("a vertex over an edge") {
    const Matrix3d onCorner = rotationBetween(Vector3d(1, 1, 1), -Vector3d::UnitZ());
    sweep(*cube, origin, *cube, above(*cube, onCorner, Vector3d(0.1, 0, 0) - half), along, step, steps);
  }
  SECTION("a round body over an edge") {
    sweep(*cube, origin, *ball, above(*ball, Matrix3d::Identity(), Vector3d(0.1, 0.03, 0) - half), along,
          step, steps);
  }
}

TEST_CASE("Rocking a face or an edge through parallel turns the normal steadily") {
  const double R = GENERATE(1.0, 10.0, 100.0);
  const double step = GENERATE(1e-4, 1e-7, 1e-9);
  const bool edge = GENERATE(false, true);
  const StpBv::Ptr cube = StpBv::build(box(0.2, 0.2, 0.2), {0.01, R});
  const Matrix3d base =
      edge ? Eigen::AngleAxisd(M_PI / 4, Vector3d::UnitY()).toRotationMatrix() : Matrix3d::Identity();
  const Vector3d axis = edge ? Vector3d(1, 0, 0) : Vector3d(0.6, 0.8, 0);
  const double height = (edge ? 0.1 + 0.1 * std::sqrt(2.0) : 0.2) + 0.05;
  PairCache cache;
  Distance last;
  for (int i = -200; i <= 200; ++i) {
    const Isometry3d p = turned(pose(base, Vector3d(0.01, 0.02, height)), axis, i * step);
    const Distance d = distance(*cube, Isometry3d::Identity(), *cube, p, &cache);
    REQUIRE(d.status == DistanceStatus::exact);
    if (i > -200) {
      // The body's points move by at most step * 0.2 m. The turn itself adds the step once for each body.
      const double core = std::min(d.distance, last.distance) + 0.02;
      const double rounding = 2 * 8 * 2.2e-16 * (2 * R + 2) / core;
      CHECK((d.normal - last.normal).norm() <= step * (2 + 0.2 / core) + rounding);
      CHECK(std::abs(d.distance - last.distance) <= step * 0.2 + 1e-15);
    }
    last = d;
  }
}
