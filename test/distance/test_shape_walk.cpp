// The feature walk of an STP-BV and a simple shape: which feature is nearest to a point, and how many pairs
// of features a query needs.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/convex/shape_feature.h"
#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/distance/threshold.h"
#include "test/reference/motion.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

using Named = std::pair<std::string, Shape>;

Shape hullOf(const std::vector<Vector3d>& points) {
  return Shape::polytopeOf(points.data(), static_cast<int>(points.size()));
}

std::vector<Named> usual() {
  static const std::vector<Vector3d> ball = geodesicSphere(0.15, 2), crate = box(0.2, 0.3, 0.4);
  return {{"hull of 162", hullOf(ball)},
          {"hull of 8", hullOf(crate)},
          {"ball", Shape::sphere(0.1)},
          {"capsule", Shape::capsule(0.1, 0.3)},
          {"box", Shape::boxOf({0.2, 0.3, 0.4})},
          {"triangle", Shape::triangleOf({0.1, 0, 0}, {-0.1, 0.1, 0}, {0, -0.2, 0.1})},
          {"cylinder", Shape::cylinderOf(0.1, 0.3)},
          {"cone", Shape::coneOf(0.1, 0.3)},
          {"ellipsoid", Shape::ellipsoidOf({0.1, 0.2, 0.15})}};
}

/// Shapes without extent along some axis, or along all of them.
std::vector<Named> flat() {
  static const std::vector<Vector3d> one{{0.1, 0, 0}}, same(5, {0.1, 0, 0}),
      line{{0, 0, 0}, {0.1, 0, 0}, {0.2, 0, 0}, {0.1, 0, 0}, {0.3, 0, 0}},
      square{{0, 0, 0}, {0.2, 0, 0}, {0.2, 0.2, 0}, {0, 0.2, 0}, {0.1, 0.1, 0}, {0.1, 0, 0}};
  return {{"hull of one", hullOf(one)},
          {"hull of one, five times", hullOf(same)},
          {"hull of a line", hullOf(line)},
          {"hull of a square", hullOf(square)},
          {"plate", Shape::boxOf({0.2, 0.3, 0})},
          {"rod", Shape::boxOf({0, 0.3, 0})},
          {"box without sides", Shape::boxOf({0, 0, 0})},
          {"capsule without length", Shape::capsule(0.1, 0)},
          {"disc", Shape::cylinderOf(0.1, 0)},
          {"rod of a cylinder", Shape::cylinderOf(0, 0.3)},
          {"cylinder without sides", Shape::cylinderOf(0, 0)},
          {"flat cone", Shape::coneOf(0.1, 0)},
          {"rod of a cone", Shape::coneOf(0, 0.3)},
          {"cone without sides", Shape::coneOf(0, 0)},
          {"flat ellipsoid", Shape::ellipsoidOf({0.1, 0.2, 0})},
          {"rod of an ellipsoid", Shape::ellipsoidOf({0.1, 0, 0})},
          {"triangle on a line", Shape::triangleOf({0, 0, 0}, {0.1, 0, 0}, {0.2, 0, 0})},
          {"triangle at a point", Shape::triangleOf({0.1, 0, 0}, {0.1, 0, 0}, {0.1, 0, 0})},
          {"narrow triangle", Shape::triangleOf({0, 0, 0}, {0.3, 0, 0}, {0.1, 1e-9, 0})}};
}

std::vector<Named> all() {
  std::vector<Named> shapes = usual();
  for (const Named& shape : flat()) shapes.push_back(shape);
  return shapes;
}

}  // namespace

TEST_CASE("the nearest feature's point is in the core, and no point of the core is nearer") {
  Random random(1);
  for (const auto& [name, shape] : all()) {
    int outside = 0, inside = 0;
    for (int i = 0; i < 3000; ++i) {
      // Some of the points are level with a face, an edge, an end or the axis.
      Vector3d x = random.uniform(0, 0.4) * random.direction();
      for (int axis = 0; axis < 3; ++axis)
        if (random.uniform(0, 1) < 0.2)
          x[axis] = std::copysign(i % 2 == 0 ? 0.0 : 0.1 + 0.05 * (i % 3), x[axis]);
      const ShapeFeature f = nearestFeature(shape, pack(x));
      CAPTURE(name, x.transpose(), static_cast<int>(f.kind), f.which);
      if (f.kind == ShapeFeature::Kind::inside) {
        // No plane separates the point from the core.
        for (int k = 0; k < 50; ++k) {
          const Vector3d m = random.direction();
          REQUIRE(m.dot(x) <= m.dot(shape.support(m)) + 1e-15);
        }
        ++inside;
        continue;
      }
      if (f.kind == ShapeFeature::Kind::none || f.kind == ShapeFeature::Kind::whole) continue;
      const Vector3d away = unpack(wayFrom(f, pack(x))), y = x - away;
      // The normal of a narrow triangle's face has an error of rounding divided by the width.
      const double rounding = name == "narrow triangle" ? 1e-7 : 2e-15;
      for (int k = 0; k < 50; ++k) {
        const Vector3d m = random.direction();
        REQUIRE(m.dot(y) <= m.dot(shape.support(m)) + rounding);
      }
      REQUIRE(away.dot(shape.support(away)) <= away.dot(y) + rounding * away.norm() + 1e-16);
      ++outside;
    }
    const bool unknown = shape.kind == ShapeKind::ellipsoid || shape.kind == ShapeKind::polytope ||
                         name == "cone without sides";
    CHECK((unknown || outside > 500));
    CHECK((shape.kind != ShapeKind::box || shape.size.minCoeff() == 0 || inside > 50));
  }
}

TEST_CASE("a query of an STP-BV and a shape apart takes few pairs of features, from memory hardly one") {
  struct Bound {
    std::string name;
    double cold, warm;
  };
  // Measured when this was written, plus a tenth.
  const Bound bounds[] = {{"hull of 162", 3.53, 2.04}, {"hull of 8", 3.24, 1.69}, {"ball", 1.86, 1.24},
                          {"capsule", 2.00, 1.48},     {"box", 2.50, 1.94},       {"triangle", 2.13, 1.39},
                          {"cylinder", 2.11, 1.57},    {"cone", 1.96, 1.46},      {"ellipsoid", 2.28, 1.26}};
  const StpBv::Ptr bodies[] = {StpBv::build(geodesicSphere(0.2, 2), {0.01, 10}),
                               StpBv::build(box(0.2, 0.3, 0.4), {0.01, 10})};
  for (const auto& [name, shape] : usual()) {
    long cold = 0, warm = 0, queries = 0;
    for (const StpBv::Ptr& body : bodies) {
      benchmark::Poses poses;
      benchmark::GeodesicMotion(benchmark::smallStep(), 1, 0.5)
          .next(poses, benchmark::GeodesicMotion::kCycle);
      PairCache cache;
      for (std::size_t i = 0; i < poses.a.size(); ++i) {
        const Distance d = distance(*body, poses.a[i], shape, poses.b[i]);
        if (!(d.lower > 0)) continue;
        CHECK(d.status == DistanceStatus::exact);
        ++queries;
        cold += d.patchPairs;
        warm += distance(*body, poses.a[i], shape, poses.b[i], &cache).patchPairs;
      }
    }
    const auto bound =
        std::find_if(std::begin(bounds), std::end(bounds), [&](const Bound& b) { return b.name == name; });
    CAPTURE(name, queries, double(cold) / double(queries), double(warm) / double(queries));
    CHECK(queries > 500);
    CHECK(static_cast<double>(cold) <= bound->cold * static_cast<double>(queries));
    CHECK(static_cast<double>(warm) <= bound->warm * static_cast<double>(queries));
  }
}

TEST_CASE(
    "a box's corners as a polytope are as far away as the box, with more points in it or far from its "
    "frame") {
  Random random(3);
  const Vector3d half(0.1, 0.15, 0.2);
  std::vector<Vector3d> corners = box(0.2, 0.3, 0.4), grid, twice = corners;
  twice.insert(twice.end(), corners.begin(), corners.end());
  for (int i = -3; i <= 3; ++i)
    for (int j = -3; j <= 3; ++j)
      for (int k = -3; k <= 3; ++k) grid.push_back(half.cwiseProduct(Vector3d(i, j, k) / 3.0));
  const Vector3d far(1000, -500, 200);
  std::vector<Vector3d> away;
  for (const Vector3d& p : grid) away.push_back(p + far);
  const Shape crate = Shape::boxOf(2 * half);
  const StpBv::Ptr bodies[] = {StpBv::build(geodesicSphere(0.2, 1), {0.01, 10}),
                               StpBv::build(box(0.2, 0.1, 0.3), {0.01, 10}),
                               StpBv::build(plate(0.3, 0.2, 0.001), {0, 1})};
  int apart = 0;
  for (const std::vector<Vector3d>* points : {&corners, &twice, &grid, &away})
    for (const StpBv::Ptr& body : bodies)
      for (int i = 0; i < 600; ++i) {
        const bool level = i % 3 > 0, stacked = i % 3 == 1;
        const Isometry3d a = pose(random.rotation(), random.direction());
        Isometry3d b = a;
        if (!level) b.linear() = random.rotation();
        b.translation() +=
            random.uniform(0.3, 1) * (stacked ? Vector3d(a.linear().col(i % 2)) : random.direction());
        Isometry3d at = b;
        if (points == &away) at.translation() = b * Vector3d(-far);
        const Distance d = distance(*body, a, hullOf(*points), at), wanted = distance(*body, a, crate, b);
        CAPTURE(points->size(), i, d.patchPairs, wanted.distance);
        REQUIRE(d.upper >= wanted.lower);
        REQUIRE(d.lower <= wanted.upper);
        if (!(wanted.lower > 0)) continue;
        ++apart;
        CHECK(d.status == DistanceStatus::exact);
        const double coordinates = points == &away ? 1e-12 : 2e-15;  // rounding of some of them
        CHECK(std::abs(d.distance - wanted.distance) <= coordinates);
        CHECK(std::abs((d.point[1] - d.point[0]).norm() - d.distance) <= 5 * coordinates);
      }
  CHECK(apart > 4000);
}

TEST_CASE("thresholds of an STP-BV and a shape of any extent are judged as their distance's bounds say") {
  Random random(2);
  const StpBv::Ptr bodies[] = {StpBv::build(geodesicSphere(0.2, 1), {0.01, 10}),
                               StpBv::build(plate(0.3, 0.2, 0.001), {0, 1})};
  long apart = 0, overlap = 0;
  for (const StpBv::Ptr& body : bodies)
    for (const auto& [name, shape] : all())
      for (int i = 0; i < 400; ++i) {
        const Isometry3d a = pose(random.rotation(), random.direction());
        const Isometry3d b =
            pose(random.rotation(), a.translation() + random.uniform(0, 0.7) * random.direction());
        const Distance d = distance(*body, a, shape, b);
        REQUIRE(d.status != DistanceStatus::invalid);
        CAPTURE(name, d.lower, d.upper);
        ++(d.lower > 0 ? apart : overlap);
        // Depths are accurate to 1e-6 of their value.
        const double slack = 1e-13 + (d.lower < 0 ? 1e-6 * -d.lower : 0);
        PairCache cache;
        for (int k = 0; k < 2; ++k) {  // without and with a last normal
          CHECK(isFartherThan(d.lower - slack, *body, a, shape, b, &cache));
          CHECK_FALSE(isFartherThan(d.upper + slack, *body, a, shape, b, &cache));
          CHECK_FALSE(isFartherByBounds(d.upper + slack, *body, a, shape, b, cache));
        }
      }
  CHECK(apart > 3000);
  CHECK(overlap > 3000);
}
