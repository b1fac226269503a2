// The builder's parts: the ball through three points, the minimum enclosing ball, the tree, the convex hull.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "fcl_stpbv/volume/ball_faces.h"
#include "fcl_stpbv/volume/ball_side.h"
#include "fcl_stpbv/volume/exact_sign.h"
#include "fcl_stpbv/volume/minimum_ball.h"
#include "fcl_stpbv/volume/point_tree.h"
#include "fcl_stpbv/volume/rolling_ball.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;

TEST_CASE("A point a millionth of rounding off the ball is told apart from one on it") {
  // Four corners of a rectangle lie exactly on one ball; one unit in the last place decides.
  const TouchingBall ball({0.1, 0.2, 0.3}, {-0.1, 0.2, 0.3}, {-0.1, -0.2, 0.3}, 10);
  REQUIRE(ball.valid());
  CHECK(ball.side({0.1, -0.2, 0.3}) == 0);
  CHECK(ball.side({0.1, -0.2, std::nextafter(0.3, 1)}) == 1);
  CHECK(ball.side({0.1, -0.2, std::nextafter(0.3, 0)}) == -1);
  CHECK(ball.side({std::nextafter(0.1, 1), -0.2, 0.3}) == 1);
  CHECK(ball.side({std::nextafter(0.1, 0), -0.2, 0.3}) == -1);
}

TEST_CASE("The side of a ball through a sliver is decided where quadruple precision cannot") {
  // Three corners of a rectangle of aspect 2^-67. Its fourth corner is on every ball through them. Points
  // next to it are off by less than 1e-43 m, along the short side.
  const double width = std::ldexp(1, -70), step = std::ldexp(1, -75);
  for (const double radius : {0.1, 10.0, 1e6, 1e15}) {
    const TouchingBall ball({0.125, 0, 0}, {0, 0, 0}, {0, -width, 0}, radius);
    REQUIRE(ball.valid());
    CHECK(ball.side({0.125, -width, 0}) == 0);
    CHECK(ball.side({0.125, -width - step, 0}) == 1);
    CHECK(ball.side({0.125, -width + step, 0}) == -1);
    CHECK(ball.turn({0.125, 0, 0}, {0, 0, 0}, {0, -width, 0}) == 1);
    CHECK(ball.turn({0.125, 0, 0}, {0, -width, 0}, {0, 0, 0}) == -1);
  }
}

TEST_CASE("Points of one plane have the side that the integers for any points tell") {
  Random random(7);
  int inside = 0, on = 0, outside = 0, undecided = 0;
  for (int k = 0; k < 3000; ++k) {
    // Small multiples of two integer vectors, scaled, so that they are exactly in one plane. In a third of
    // the cases one vector is so short that some coordinates need more bits than the fast path has.
    const double far = std::ldexp(1, k % 3 == 0 ? random.below(90) : 0);
    const auto whole = [&](int most) { return static_cast<double>(random.below(2 * most + 1) - most); };
    const Vector3d u = far * Vector3d(whole(9), whole(9), whole(9)), v(whole(9), whole(9), whole(9));
    const auto at = [&](double x, double y) { return Vector3d(std::ldexp(1, -12) * (x * u + y * v)); };
    const Vector3d a = at(0, 0), b = at(whole(5), whole(5)), c = at(whole(5), whole(5));
    // The fourth corner of a parallelogram is on the ball if the parallelogram is a rectangle.
    const Vector3d p = k % 2 == 0 ? Vector3d(b + c - a) : at(whole(5), whole(5));
    const TouchingBall ball(a, b, c, std::ldexp(far, 5));
    if (!ball.valid()) continue;
    const BallPoints points{a, b, c, std::ldexp(far, 5)};
    const std::optional<int> side = coplanarSide(points, p);
    undecided += !side;
    if (!side) continue;
    CAPTURE(k, a, b, c, p);
    CHECK(*side == exactSide(points, p));
    CHECK(*side == ball.side(p));
    ++(*side < 0 ? inside : *side > 0 ? outside : on);
  }
  CAPTURE(inside, on, outside, undecided);
  CHECK(std::min({inside, on, outside, undecided}) > 10);
  // A point that is off the plane by the last bit.
  CHECK(!coplanarSide({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, 10}, {0.25, 0.25, std::nextafter(1, 2)}));
  CHECK(coplanarSide({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, 10}, {1, 1, 1}) == 0);
  CHECK(coplanarSide({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, 10}, {1, std::nextafter(1, 2), 1}) == 1);
  CHECK(coplanarSide({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, 10}, {1, std::nextafter(1, 0), 1}) == -1);
}

TEST_CASE("An infinite radius makes the ball the plane through its points") {
  const TouchingBall plane({0, 0, 1}, {1, 0, 1}, {0, 1, 1}, std::numeric_limits<double>::infinity());
  CHECK((plane.normal() - Vector3d(0, 0, 1)).norm() == 0);
  CHECK(plane.side({5, 7, 1}) == 0);
  CHECK(plane.side({5, 7, std::nextafter(1.0, 2)}) == 1);
  CHECK(plane.turn({0, 0, 1}, {1, 0, 1}, {0, 1, 1}) == 1);
  CHECK(plane.turn({0, 0, 1}, {1, 0, 1}, {2, 0, 1}) == 0);
}

TEST_CASE("The minimum enclosing ball is held by its points and no smaller one holds them") {
  Random random(5);
  for (int k = 0; k < 200; ++k) {
    const Cloud points = randomHull(1 + random.below(60), {0.3, 0.2, 0.1 * random.below(2)},
                                    static_cast<std::uint64_t>(k + 1));
    const Ball ball = minimumEnclosingBall(points);
    std::vector<Vector3d> held;
    for (const Vector3d& p : points) {
      CHECK((p - ball.centre).norm() <= ball.radius);
      if ((p - ball.centre).norm() > ball.radius * (1 - 1e-12)) held.push_back(p);
    }
    // Moving the centre in any direction must increase the distance of some touching point, because the
    // centre is in their convex hull.
    for (int d = 0; d < 100; ++d) {
      const Vector3d step = 1e-3 * random.direction();
      double farthest = 0;
      for (const Vector3d& p : held) farthest = std::max(farthest, (p - ball.centre - step).norm());
      CHECK(farthest > ball.radius - 1e-13);
    }
  }
}

TEST_CASE("The tree finds the highest point over a ball and all points in a range") {
  const Cloud points = randomHull(3000, {0.3, 0.2, 0.1}, 4);
  PointTree tree(points);
  Random random(12);
  std::vector<int> found;
  for (int k = 0; k < 200; ++k) {
    const Vector3d anchor = points[static_cast<std::size_t>(random.below(3000))], n = random.direction();
    const double curvature = k % 3 == 0 ? 0 : random.uniform(0, 3);
    const PointTree::Highest top = tree.highest(anchor, n, curvature, 1e-15, &found);
    double best = -1e9;
    for (const Vector3d& p : points)
      best = std::max(best, 0.5 * curvature * (p - anchor).squaredNorm() + n.dot(p - anchor));
    CHECK(top.height == Approx(best).margin(1e-15));
    const double radius = random.uniform(0, 0.1);
    tree.within(anchor, radius, &found);
    std::size_t expected = 0;
    for (const Vector3d& p : points) expected += (p - anchor).norm() <= radius;
    CHECK(found.size() == expected);
  }
}

TEST_CASE("The rolled convex hull is convex, closed and holds all points") {
  for (const Cloud& points : {box(0.2, 0.4, 0.6), cylinder(0.1, 0.3), geodesicSphere(0.2, 2),
                              randomHull(300, {0.3, 0.2, 0.1}, 6)}) {
    const RolledHull hull = convexHull(points);
    std::size_t sides = 0;
    for (const std::vector<int>& ring : hull.faces) {
      sides += ring.size();
      const auto t = wideTriangle(points, ring);
      const auto at = [&](int i) { return points[static_cast<std::size_t>(i)]; };
      const Vector3d n = (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])).normalized();
      for (const Vector3d& p : points) CHECK(n.dot(p - at(t[0])) <= 1e-15);
    }
    CHECK(hull.vertices.size() + hull.faces.size() == sides / 2 + 2);
  }
}

TEST_CASE("The rolled faces are those of the definition") {
  Random random(31);
  for (int k = 0; k < 60; ++k) {
    Cloud points = k % 3 == 0 ? box(0.2, 0.4, 0.1 + 0.01 * k) : randomHull(5 + k / 2, {0.3, 0.2, 0.1}, k + 1);
    const Eigen::Matrix3d turn = random.rotation();
    for (Vector3d& p : points) p = turn * p;
    const double radius = minimumEnclosingBall(points).radius * (1 + std::pow(10.0, random.uniform(-4, 4)));
    CAPTURE(k, radius);
    const RolledHull rolled = rollBall(points, radius), defined = hullByDefinition(points, radius);
    if (!rolled.faces.empty()) CHECK(rolled.vertices == defined.vertices);  // otherwise a sphere or a spindle
    using Rings = std::set<std::vector<int>>;
    CHECK(Rings(rolled.faces.begin(), rolled.faces.end()) ==
          Rings(defined.faces.begin(), defined.faces.end()));
  }
}
