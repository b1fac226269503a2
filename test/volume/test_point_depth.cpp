// The depth of a point from the faces' balls alone, compared with the stationary normals of all patches
// (signedDistance) and with the support function from its definition.
#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/point_depth.h"
#include "test/reference/brute_support.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;

namespace {

struct Inside {
  Cloud cloud;
  double r;
};

std::vector<Inside> insides() {
  Cloud twice = randomHull(20, {0.3, 0.2, 0.1}, 5);
  for (const Vector3d& p : Cloud(twice)) twice.push_back(p + Vector3d(1e-9, -2e-9, 1e-9));
  return {{box(0.3, 0.2, 0.1), 0.01},
          {plate(0.3, 0.2), 1e-4},
          {needle(0.5), 1e-3},
          {cylinder(0.1, 0.4, 16), 0.02},
          {geodesicSphere(0.2, 2), 0.01},
          {randomHull(40, {0.2, 0.15, 0.1}, 3), 0},
          {randomHull(5, {0.2, 0.2, 0.2}, 8), 0.01},
          {twice, 0.01},
          {box(3e3, 2e3, 1e3), 1}};
}

/// A point in the cloud's hull, near its surface or not.
Vector3d inHull(const Cloud& cloud, Random& random) {
  Vector3d sum(0, 0, 0);
  double weights = 0;
  const double power = random.uniform(1, 8);
  for (const Vector3d& p : cloud) {
    const double w = std::pow(random.uniform(0, 1), power);
    sum += w * p;
    weights += w;
  }
  return sum / weights;
}

}  // namespace

TEST_CASE("The depth from the faces' balls is the least over all patches") {
  Random random(41);
  int told = 0, deeper = 0;
  for (const Inside& body : insides())
    for (const double over : {1e-9, 1e-3, 0.1, 1.0, 30.0, 1e4, 1e6}) {
      const double R = (1 + over) * StpBv::smallestR(body.cloud, body.r);
      const StpBv::Ptr volume = StpBv::build(body.cloud, {body.r, R});
      for (int k = 0; k < 100; ++k) {
        const Vector3d p = k == 0 ? volume->centre() : inHull(body.cloud, random);
        const double exact = -signedDistance(*volume, p) - body.r;
        const auto found = detail::pointDepth(*volume, p);
        const double cap = volume->tables().capHeight;
        deeper += exact > cap * (1 + 1e-9) && exact < 0.99 * volume->radii().rho;
        if (!found) continue;
        ++told;
        CAPTURE(body.cloud.size(), R, k, cap);
        // A dozen operations with coordinates of the body's size.
        REQUIRE(std::abs(found->depth - exact) <= 4e-15 * volume->extent());
        REQUIRE(std::abs(found->normal.norm() - 1) <= 1e-13);
        // Along the way out, the body ends after the depth.
        REQUIRE(std::abs(volume->support(found->normal) - body.r - found->normal.dot(p) - found->depth) <=
                4e-15 * volume->extent());
      }
    }
  REQUIRE(told > 2500);
  REQUIRE(told >= deeper);
}

TEST_CASE("Along no normal a point leaves the core sooner than its depth, by the definition of the core") {
  const Cloud cloud = randomHull(9, {0.2, 0.15, 0.1}, 12);
  Random random(42);
  int told = 0;
  for (const double R : {1.0, 5.0, 40.0}) {
    const StpBv::Ptr volume = StpBv::build(cloud, {0, R});
    for (int k = 0; k < 40; ++k) {
      const Vector3d p = inHull(cloud, random);
      const auto found = detail::pointDepth(*volume, p);
      if (!found) continue;
      ++told;
      const auto depthAlong = [&](const Vector3d& n) {
        return static_cast<double>(bruteSupport(cloud, 0, R, n)) - n.dot(p);
      };
      REQUIRE(std::abs(depthAlong(found->normal) - found->depth) <= 1e-15 * (1 + R));
      for (int i = 0; i < 60; ++i) REQUIRE(depthAlong(random.direction()) >= found->depth - 1e-15 * (1 + R));
    }
  }
  REQUIRE(told > 60);
}

TEST_CASE("A volume without faces, a flat one and a point outside have no depth from faces") {
  const Cloud spindle{{0, 0, 0}, {0.3, 0, 0}}, ball{{0.1, 0, 0}};
  const Cloud flat{{0, 0, 0}, {0.3, 0, 0}, {0, 0.3, 0}};
  for (const Cloud& cloud : {spindle, ball, flat})
    CHECK_FALSE(detail::pointDepth(*StpBv::build(cloud, {0.01, 1}), {0.05, 0.05, 0}));
  const StpBv::Ptr cube = StpBv::build(box(0.2, 0.2, 0.2), {0.01, 10});
  CHECK(detail::pointDepth(*cube, {0.05, 0, 0}));
  CHECK_FALSE(detail::pointDepth(*cube, {0.15, 0, 0}));
  CHECK_FALSE(detail::pointDepth(*cube, {0.0999, 0, 0}));  // less deep than the bulge of the faces
}
