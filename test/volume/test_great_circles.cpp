// Points on a great circle of the rolling ball: the balls of faces on both sides coincide, and a point
// between the others is on the surface of their spindle.
#include <Eigen/Geometry>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/volume/ball_side.h"
#include "fcl_stpbv/volume/exact_sign.h"
#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/stp_bv.h"
#include "test/reference/brute_support.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;

namespace {

// The whole numbers x, y, z with x^2 + y^2 + z^2 = radius^2. With `isFlat` only those with z = 0.
Cloud wholePoints(int radius, bool isFlat = false) {
  Cloud points;
  for (int x = -radius; x <= radius; ++x)
    for (int y = -radius; y <= radius; ++y)
      for (int z = isFlat ? 0 : -radius; z <= (isFlat ? 0 : radius); ++z)
        if (x * x + y * y + z * z == radius * radius) points.push_back(Vector3d(x, y, z));
  return points;
}

}  // namespace

TEST_CASE("The ball through three points of its great circle has the other points of its sphere on it") {
  for (const int radius : {3, 9, 15}) {
    const Cloud points = wholePoints(radius);
    int tried = 0;
    for (const Vector3d& a : points)
      for (const Vector3d& b : points) {
        const TouchingBall ball(a, b, -a, radius);
        if (!ball.valid() || ++tried % 97 != 0) continue;
        for (const Vector3d& p : points) {
          CAPTURE(radius, a, b, p);
          CHECK(ball.side(p) == 0);
          CHECK(ball.side(1.0625 * p) == 1);
          CHECK(ball.side(0.9375 * p) == exactSide({a, b, -a, static_cast<double>(radius)}, 0.9375 * p));
        }
      }
    CHECK(tried > 97);
  }
}

TEST_CASE("Points on an arc of the ball's radius, or off it by a few roundings, have the right volume") {
  Random random(6);
  int built = 0;
  for (int k = 0; k < 1500; ++k) {
    const int radius = std::array<int, 4>{5, 15, 25, 65}[static_cast<std::size_t>(k % 4)];
    const double scale = std::array<double, 3>{1, 1.0 / 128, 0.01}[static_cast<std::size_t>(k % 3)];
    const Eigen::Matrix3d turn = k % 2 == 0 ? Eigen::Matrix3d::Identity() : random.rotation();
    const Cloud circle = wholePoints(radius, true);
    const double middle = random.uniform(0, 7), width = random.uniform(0.3, 2.9);
    Cloud points;
    for (const Vector3d& p : circle) {
      const double away =
          std::acos(std::min(1.0, p.dot(Vector3d(std::cos(middle), std::sin(middle), 0)) / radius));
      if (away < width / 2 && points.size() < 7) points.push_back(turn * (scale * p));
    }
    double R = scale * radius;
    for (int step = k % 9; step > 4; --step) R = std::nextafter(R, 1e9);
    for (int step = k % 9; step < 4; ++step) R = std::nextafter(R, 0);
    if (points.size() < 3 || !(R > (1 + 1e-9) * StpBv::smallestR(points, 0))) continue;
    ++built;
    const StpBv::Ptr volume = StpBv::build(points, {0, R});
    CAPTURE(k, points.size(), R, volume->vertexCount(), volume->faceCount());
    CHECK(verify(*volume, points).message == "ok");
    for (int i = 0; i < 20; ++i) {
      const Vector3d n = random.direction();
      CHECK(std::abs(volume->support(n) - static_cast<double>(bruteSupport(points, 0, R, n))) <= 1e-14 * R);
    }
  }
  CHECK(built > 500);
}

TEST_CASE("A cap of points on one ball of the ball's own radius has the right volume") {
  Random random(8);
  for (const int radius : {3, 7, 9, 15})
    for (int k = 0; k < 60; ++k) {
      const Vector3d top = k % 2 == 0 ? Vector3d::Unit(k % 3) : random.direction();
      const double low = random.uniform(0.05, 0.6);
      Cloud points;
      for (const Vector3d& p : wholePoints(radius))
        if (p.dot(top) > low * radius && random.below(3) > 0 && points.size() < 16) points.push_back(p);
      if (points.size() < 3) continue;
      CAPTURE(radius, k, points.size());
      const double R = radius;
      const StpBv::Ptr volume = StpBv::build(points, {0, R});
      CHECK(verify(*volume, points).message == "ok");
      for (int i = 0; i < 20; ++i) {
        const Vector3d n = random.direction();
        CHECK(std::abs(volume->support(n) - static_cast<double>(bruteSupport(points, 0, R, n))) <= 1e-14 * R);
      }
    }
}

TEST_CASE("Many points on an arc of the ball's radius are a spindle") {
  for (const int count : {150, 300}) {
    Cloud points;
    for (int i = 0; i < count; ++i) {
      const double angle = 0.2 + 1.5 * i / (count - 1);
      points.push_back({std::cos(angle), std::sin(angle), 0});
    }
    const StpBv::Ptr volume = StpBv::build(points, {0, 1}),
                     ends = StpBv::build({points.front(), points.back()}, {0, 1});
    CHECK(verify(*volume, points).message == "ok");
    Random random(3);
    for (int i = 0; i < 200; ++i) {
      const Vector3d n = random.direction();
      CHECK(std::abs(volume->support(n) - ends->support(n)) <= 1e-14);
    }
  }
}
