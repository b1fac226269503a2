// Smooth covers of primitives: they contain the primitives, exceed them by at most the stated excess, and
// remove the jumps.
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/robot/fitted_radii.h"
#include "fcl_stpbv/robot/primitive_cover.h"
#include "test/reference/reference.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;

namespace {

// A primitive, its support function from the definition, and the least margin that its cover promises.
struct Primitive {
  std::string name;
  std::shared_ptr<fcl::CollisionGeometryd> geometry;
  std::function<double(const Vector3d&)> support;
  bool keepsMargin;
  BodySize size;
};

std::vector<Primitive> primitives(Random& random) {
  const double a = random.uniform(0.005, 0.3), l = random.uniform(0.005, 0.6);
  const Vector3d sides(random.uniform(0.005, 0.5), random.uniform(0.005, 0.5), random.uniform(0.005, 0.5));
  const auto across = [](const Vector3d& n) { return std::hypot(n.x(), n.y()); };
  return {
      {"sphere", std::make_shared<fcl::Sphered>(a), [=](const Vector3d&) { return a; }, false, {2 * a, a}},
      {"capsule",
       std::make_shared<fcl::Capsuled>(a, l),
       [=](const Vector3d& n) { return a + std::abs(n.z()) * l / 2; },
       false,
       {2 * a, a + l / 2}},
      {"box",
       std::make_shared<fcl::Boxd>(sides),
       [=](const Vector3d& n) { return n.cwiseAbs().dot(sides) / 2; },
       true,
       {sides.minCoeff(), sides.norm() / 2}},
      {"cylinder",
       std::make_shared<fcl::Cylinderd>(a, l),
       [=](const Vector3d& n) { return a * across(n) + std::abs(n.z()) * l / 2; },
       true,
       {std::min(2 * a, l), std::hypot(a, l / 2)}},
      {"cone",
       std::make_shared<fcl::Coned>(a, l),
       [=](const Vector3d& n) { return std::max(a * across(n) - n.z() * l / 2, n.z() * l / 2); },
       true,
       {std::min(a, l), std::hypot(a, l / 2)}},
  };
}

// Largest change of the distance's derivative by the second body's twist in one of `steps` steps, while it
// turns about the line of centres through a parallel position.
double largestStep(const fcl::CollisionGeometryd& a, const fcl::CollisionGeometryd& b, int steps) {
  constexpr double kAngle = 0.05;
  double most = 0;
  TwistGradient last = TwistGradient::Zero();
  for (int k = 0; k <= steps; ++k) {
    const double angle = kAngle * (2.0 * k / steps - 1);
    fcl::Transform3d pose(Eigen::Translation3d(0, 0.5, 0));
    pose.linear() =
        (Eigen::AngleAxisd(angle, Vector3d::UnitX()) * Eigen::AngleAxisd(0.3 * angle, Vector3d::UnitY()))
            .toRotationMatrix();
    const DistanceAnswer d = distance(a, fcl::Transform3d::Identity(), b, pose);
    REQUIRE(d.status != DistanceStatus::invalid);
    if (k > 0) most = std::max(most, (d.gradient[1] - last).norm());
    last = d.gradient[1];
  }
  return most;
}

}  // namespace

TEST_CASE(
    "a primitive's cover contains it, by r where it promises that, and exceeds it by no more than it says") {
  Random random(11);
  for (int round = 0; round < 40; ++round) {
    for (const Primitive& p : primitives(random)) {
      StpBvOptions radii{random.below(4) == 0 ? 0.0 : random.uniform(1e-4, 0.02), random.uniform(2, 20)};
      if (random.below(2) == 0) radii = fittedRadii(p.size);
      const PrimitiveCover cover = primitiveCover(*p.geometry, radii);
      INFO(p.name << ", r " << radii.r << ", R " << radii.R);
      REQUIRE(cover.volume);
      const Radii& own = cover.volume->radii();
      const ReferenceBody body = referenceBody(cover.volume->vertices(), own.r, own.R);
      const double rounding =
          1e-15 * own.R + 1e-15;  // of the vertices' coordinates, seen from a centre R away
      double most = -1, least = 1;
      for (int k = 0; k < 400; ++k) {
        Vector3d n = random.direction();
        if (k < 6) n = Vector3d::Unit(k % 3) * (k < 3 ? 1 : -1);
        const double excess =
            static_cast<double>(referenceSupport(body, n.cast<long double>())) - p.support(n);
        most = std::max(most, excess);
        least = std::min(least, excess);
      }
      CHECK(least >= (p.keepsMargin ? radii.r : 0) - rounding);
      CHECK(most <= cover.excess.max + rounding);
      if (p.name == "sphere") CHECK(cover.excess.max == 0);
      // For a cylinder and a cone, the stated excess also contains the polygon's corners.
      if (p.name == "box" || p.name == "capsule") CHECK(most >= 0.98 * cover.excess.max - rounding);
      CHECK(cover.excess.mean <= cover.excess.max);
    }
  }
}

TEST_CASE("a primitive larger than R is covered with a larger R") {
  const fcl::Boxd ground(100, 100, 0.1);
  const PrimitiveCover cover = primitiveCover(ground, {0.01, 10});
  REQUIRE(cover.volume);
  CHECK(cover.volume->radii().R > 71);
  CHECK(cover.excess.max < 0.5);
  CHECK(primitiveCover(fcl::Sphered(50), {0.01, 10}).excess.max == 0);
}

TEST_CASE(
    "bodies that turn through parallel jump while both are flat, a capsule too, and not once one is "
    "covered") {
  const fcl::Sphered sphere(0.05);
  const fcl::Capsuled capsule(0.05, 0.3);
  const fcl::Boxd box(0.2, 0.1, 0.3);
  const fcl::Cylinderd cylinder(0.05, 0.3);
  const std::vector<const fcl::CollisionGeometryd*> flat{&capsule, &box, &cylinder};
  for (const fcl::CollisionGeometryd* a : flat) {
    for (const fcl::CollisionGeometryd* b : flat) {
      INFO(a->getNodeType() << " " << b->getNodeType());
      CHECK(largestStep(*a, *b, 10000) > 0.05);  // the witness point moves from end to end: 0.3 m of lever
      const PrimitiveCover cover = primitiveCover(*a, {0.01, 10});
      const StpBvGeometry smooth(cover.volume);
      const double coarse = largestStep(smooth, *b, 1000), fine = largestStep(smooth, *b, 10000);
      CHECK(fine < 0.2 * coarse);
      CHECK(coarse < 0.05);
    }
    const StpBvGeometry ball(primitiveCover(sphere, {0.01, 10}).volume);
    CHECK(largestStep(ball, *a, 10000) < 0.2 * largestStep(ball, *a, 1000));
  }
}
