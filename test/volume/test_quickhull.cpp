// Quickhull with balls, and the local tests of its results.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/ball_quickhull.h"
#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/minimum_ball.h"
#include "fcl_stpbv/volume/outer_points.h"
#include "fcl_stpbv/volume/quick_ball.h"
#include "fcl_stpbv/volume/quickhull.h"
#include "fcl_stpbv/volume/rolling_ball.h"
#include "fcl_stpbv/volume/surface_check.h"
#include "test/reference/shapes.h"
#include "test/reference/trials.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;

namespace {

Cloud onEllipsoid(int count, const Vector3d& half, std::uint64_t seed) {
  Random random(seed);
  Cloud points;
  for (int i = 0; i < count; ++i) points.push_back(half.cwiseProduct(random.direction()));
  return points;
}

}  // namespace

TEST_CASE("A side in double precision is the exact one") {
  Random random(21);
  int uncertain = 0;
  for (int k = 0; k < 3000; ++k) {
    const double thin = std::pow(10, random.uniform(-7, 0)), radius = std::pow(10, random.uniform(-0.2, 3));
    const Vector3d a = 0.3 * random.direction(), b = a + 0.1 * random.direction(),
                   c = b + 0.1 * thin * random.direction();
    QuickBall quick(a, b, c, radius);
    const TouchingBall exact(a, b, c, radius);
    REQUIRE(quick.valid() == exact.valid());
    for (int i = 0; i < 20; ++i) {
      Vector3d p = i < 10 ? Vector3d(0.3 * random.direction()) : Vector3d((a + b + c) / 3);
      // Points next to the ball: moved onto it along its normal, and then off it by little.
      if (i >= 5) {
        p -= static_cast<double>(exact.height(p)) * exact.normalAt(p);
        p += std::pow(10, random.uniform(-18, -9)) * random.direction();
      }
      double height = 0;
      CHECK(quick.side(p, &height) == exact.side(p));
      uncertain += std::abs(height) <= quick.heightError(p);
      CHECK(std::abs(height - static_cast<double>(exact.height(p))) <= quick.heightError(p));
    }
  }
  CHECK(uncertain > 100);  // the test had both kinds of points
}

TEST_CASE("Quickhull finds the faces that the ball rolls onto") {
  Random random(22);
  for (int k = 0; k < trials(80); ++k) {
    Cloud points;
    switch (k % 4) {
      case 0:
        points = onEllipsoid(20 + 10 * k, {0.3, 0.2, 0.1}, k + 1);
        break;
      case 1:
        points = randomHull(20 + 20 * k, {0.3, 0.2, 0.1}, k + 1);
        break;
      case 2:
        points = geodesicSphere(0.2, 1 + k % 3);
        break;
      default:  // points inside, on the surface, and duplicated
        points = onEllipsoid(100, {0.3, 0.2, 0.1}, k + 1);
        for (int i = 0; i < 200; ++i)
          points.push_back(random.uniform(0, 1) * points[static_cast<std::size_t>(random.below(100))]);
    }
    const double least = minimumEnclosingBall(points).radius;
    for (const double radius : {least * (1 + 1e-6), least * 1.01, least * 3, 10.0, 1e4, flatRadius(points)}) {
      CAPTURE(k, radius, points.size());
      const RolledHull quick = quickBallHull(points, radius), rolled = rollBall(points, radius);
      if (radius > 2 * least) REQUIRE(!quick.faces.empty());
      if (quick.faces.empty())
        continue;  // the surface of an ellipsoid near its smallest ball does not consist of triangles only
      // With a small ball a point may stick out over an edge only. Then the check hands the cloud to the
      // roll.
      if (quick.vertices.size() < rolled.vertices.size()) continue;
      CHECK(quick.vertices == rolled.vertices);
      CHECK(quick.faces == rolled.faces);
    }
  }
}

TEST_CASE("The convex hull of a finely divided box has no vertex inside its flat faces but by rounding") {
  // Every point is duplicated, and most lie in a flat face. After a rotation they are off it by rounding.
  constexpr int kSide = 30;
  Cloud points;
  for (int i = 0; i <= kSide; ++i)
    for (int j = 0; j <= kSide; ++j)
      for (const double z : {-0.125, 0.125}) {
        const double x = -0.125 + 0.25 * i / kSide, y = -0.125 + 0.25 * j / kSide;
        for (const Vector3d& p : {Vector3d(x, y, z), Vector3d(y, z, x), Vector3d(z, x, y)})
          points.push_back(p);
      }
  const RolledHull straight = convexHull(points);
  CHECK(straight.vertices.size() == 8);
  CHECK(straight.faces.size() == 6);
  const Eigen::Matrix3d turn = Random(3).rotation();
  for (Vector3d& p : points) p = turn * p;
  const RolledHull turned = convexHull(points);
  CHECK(turned.vertices.size() < 200);
  for (const std::vector<int>& ring : turned.faces) {
    const auto t = wideTriangle(points, ring);
    const Vector3d& a = points[static_cast<std::size_t>(t[0])];
    const Vector3d n =
        (points[static_cast<std::size_t>(t[1])] - a).cross(points[static_cast<std::size_t>(t[2])] - a);
    // A face as thin as rounding has no reliable plane.
    if (n.norm() < 1e-6) continue;
    for (const Vector3d& p : points) CHECK(n.normalized().dot(p - a) <= 1e-15);
  }
}

TEST_CASE("A point that sticks out over the middle of an edge alone is a vertex") {
  // The ball that rolls over the edge of a ridge meets the point on its way, although neither of the faces'
  // balls reaches it. The point is lower than the arc in which these balls meet, and higher than the torus
  // between them.
  const double length = 0.2, R = 1, half = 0.5 * length;
  const Cloud ridge{{-half, 0, 0}, {half, 0, 0}, {0, 0.1, -0.1}, {0, -0.1, -0.1}};
  const StpBv::Ptr without = StpBv::build(ridge, {0, R});
  REQUIRE(without->faceCount() == 4);
  const double torus = without->surfacePoint({0, 0, 1}).z();
  for (const double out : {1e-6, 1e-9, 1e-12, -1e-12, -1e-6}) {
    Cloud points = ridge;
    points.push_back({0, 0, torus + out});
    CAPTURE(out, torus);
    const StpBv::Ptr volume = StpBv::build(points, {0, R});
    CHECK(volume->vertexCount() == (out > 0 ? 5 : 4));
    CHECK(verify(*volume, points).message == "ok");
    const Soundness found = soundnessOf(*without, points, {points.back()});
    CHECK((found == Soundness::exact) == (out < 0));
  }
}

TEST_CASE("A point outside a volume makes it broken, one outside by rounding does not") {
  const Cloud points = geodesicSphere(0.2, 2);
  const StpBv::Ptr volume = StpBv::build(points, {0.01, 10});
  const Vector3d n = volume->patch(volume->facePatch(7)).axis, x = volume->surfacePoint(n) - 0.01 * n;
  CHECK(soundnessOf(*volume, points, {}) == Soundness::exact);
  CHECK(soundnessOf(*volume, points, {x - 1e-6 * n}) == Soundness::exact);
  CHECK(soundnessOf(*volume, points, {x + 3e-15 * n}) == Soundness::sound);
  CHECK(soundnessOf(*volume, points, {x + 1e-12 * n}) == Soundness::off);
  CHECK(soundnessOf(*volume, points, {x + 1e-6 * n}) == Soundness::broken);
}

TEST_CASE("Of a large cloud only points well inside are left out") {
  Random random(6);
  const Eigen::Matrix3d turn = random.rotation();
  for (const bool isBall : {false, true})
    for (const Vector3d& half : {Vector3d(0.3, 0.2, 0.1), Vector3d(0.3, 0.2, 1e-4)})
      for (const double away : {0.0, 1e3}) {
        Cloud points;
        for (int i = 0; i < 40000; ++i) {
          const Vector3d p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
          if (!isBall || p.norm() < 1)
            points.push_back(turn * half.cwiseProduct(p) + away * Vector3d(1, 2, 3));
        }
        CAPTURE(isBall, half.transpose(), away);
        const std::vector<int> outer = outerPoints(points);
        std::vector<char> stays(points.size(), 0);
        for (const int i : outer) stays[static_cast<std::size_t>(i)] = 1;
        for (const int i : convexHull(points).vertices) CHECK(stays[static_cast<std::size_t>(i)]);
        if (half.z() > 0.01 && away == 0) CHECK(outer.size() < points.size() / 2);
        Cloud left;
        for (const int i : outer) left.push_back(points[static_cast<std::size_t>(i)]);
        const StpBv::Ptr all = StpBv::build(points, {0.01, 10});
        CHECK(all->vertices() == StpBv::build(left, {0.01, 10})->vertices());
        CHECK(soundnessOf(*all, points, points) <= Soundness::sound);
      }
  Cloud flat = randomHull(20000, {0.3, 0.2, 0.1}, 1);
  for (Vector3d& p : flat) p.z() = 0;
  CHECK(outerPoints(flat).size() == 20000);
  CHECK(outerPoints(onEllipsoid(20000, {0.3, 0.2, 0.1}, 1)).size() == 20000);
  CHECK(outerPoints(randomHull(1000, {0.3, 0.2, 0.1}, 1)).size() == 1000);
  CHECK(outerPoints(Cloud(20000, Vector3d(1, 2, 3))).size() == 20000);
}

TEST_CASE("Points in space order are each there once") {
  Cloud points = onEllipsoid(500, {0.3, 0.2, 0.1}, 4);
  for (int i = 0; i < 100; ++i) points.push_back(points[static_cast<std::size_t>(3 * i)]);
  std::vector<int> order = spaceOrder(points);
  double steps = 0;
  for (std::size_t i = 1; i < order.size(); ++i)
    steps +=
        (points[static_cast<std::size_t>(order[i])] - points[static_cast<std::size_t>(order[i - 1])]).norm();
  CHECK(steps < 0.05 * 500);  // the next point is near; in random order it would be 0.3 m away
  std::sort(order.begin(), order.end());
  REQUIRE(order.size() == 500);
  for (int i = 0; i < 500; ++i) CHECK(order[static_cast<std::size_t>(i)] == i);
  CHECK(spaceOrder({}).empty());
  CHECK(spaceOrder({{1, 2, 3}, {1, 2, 3}}).size() == 1);
}

TEST_CASE("Quickhull asks the sides of a few points a vertex, however many") {
  for (const int count : {1000, 30000}) {
    const QuickFaces quick = quickhull(onEllipsoid(count, {0.2, 0.2, 0.2}, 1), 10);
    REQUIRE(quick.faces.size() == static_cast<std::size_t>(2 * count - 4));
    CHECK(static_cast<double>(quick.asked) < 12 * count * std::log2(count));
  }
}

TEST_CASE("Points on a line but for rounding have its ends as their convex hull") {
  Random random(22);
  for (int trial = 0; trial < 4000; ++trial) {
    const double width = std::pow(10, random.uniform(-18, -12));
    const Vector3d middle = random.direction(), axis = random.direction();
    Cloud points;
    for (int i = 0; i < 3 + trial % 8; ++i)
      points.push_back(middle + random.uniform(-1, 1) * axis + width * random.direction());
    double lowest = 1e300, highest = -1e300;
    const auto along = [&](const Vector3d& p) { return axis.dot(p - middle); };
    for (const int i : convexHull(points).vertices) {
      lowest = std::min(lowest, along(points[static_cast<std::size_t>(i)]));
      highest = std::max(highest, along(points[static_cast<std::size_t>(i)]));
    }
    INFO("trial " << trial << ", width " << width);
    for (const Vector3d& p : points) {
      // For coordinates of 2 m. A point may differ across the direction by `width`.
      REQUIRE(along(p) > lowest - 1e-15 - width);
      REQUIRE(along(p) < highest + 1e-15 + width);
    }
  }
}

TEST_CASE("Many points on the sides of one polygon have its corners as their convex hull") {
  // Of 500 such clouds, these are the ones whose faces neither quickhull nor the roll can close.
  for (const std::uint64_t seed : {107, 130, 154, 228, 353, 406, 412, 481}) {
    Random random(seed);
    const int corners = 5 + random.below(2);
    const double radius = random.uniform(0.1, 5);
    Cloud cloud;
    for (int i = 0; i < corners; ++i) {
      const double angle = kTwoPi * (i + random.uniform(0, 0.8)) / corners;
      cloud.emplace_back(7.4505394563727787, radius * std::cos(angle) + 8, radius * std::sin(angle) + 5);
    }
    for (int i = 0; i < 150; ++i) {
      const int side = random.below(corners);
      const double share = random.uniform(0, 1) * (random.below(3) == 0 ? 1e-3 : 1.0);
      const Vector3d from = cloud[at(side)], to = cloud[at((side + 1) % corners)];
      cloud.push_back((1 - share) * from + share * to);
    }
    CAPTURE(seed);
    const RolledHull hull = convexHull(cloud);
    REQUIRE(hull.faces.size() == 2);
    CHECK(hull.faces[0].size() == hull.vertices.size());
    for (int i = 0; i < corners; ++i) CHECK(std::count(hull.vertices.begin(), hull.vertices.end(), i) == 1);
    // Every point is below the plane of each side, up to the rounding of coordinates of 13 m.
    const auto ring = hull.faces[0];
    const double turn =
        (cloud[at(ring[1])] - cloud[at(ring[0])]).cross(cloud[at(ring[2])] - cloud[at(ring[0])]).x();
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vector3d start = cloud[at(ring[k])],
                     along = (cloud[at(ring[(k + 1) % ring.size()])] - start).normalized();
      for (const Vector3d& p : cloud) CHECK(std::copysign(1, turn) * along.cross(p - start).x() > -2e-14);
    }
  }
}
