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
