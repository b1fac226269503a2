// Polytopes with many vertices, with simple shapes and with each other. The search examines few of the
// vertices, but the answer must be that of all. Also flat faces with more vertices than the search takes for
// few, and faces parallel to the other body's.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "fcl_stpbv/convex/shape_curvature.h"
#include "fcl_stpbv/distance/distance.h"
#include "test/reference/shape_reference.h"
#include "test/reference/trials.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

TestShape polytope(const std::string& name, const Cloud& cloud) {
  TestShape shape{name, {}, std::make_shared<Cloud>(cloud)};
  shape.shape = Shape::polytopeOf(shape.vertices->data(), static_cast<int>(cloud.size()));
  return shape;
}

Cloud grid(double side, int count) {
  Cloud points;
  for (int i = 0; i < count; ++i)
    for (int k = 0; k < count; ++k)
      for (const double z : {-0.02, 0.02})
        points.emplace_back(side * (i / (count - 1.0) - 0.5), side * (k / (count - 1.0) - 0.5), z);
  return points;
}

}  // namespace

TEST_CASE("polytopes of many vertices are as far from any shape as all of their vertices say") {
  const std::vector<TestShape> polytopes{
      polytope("ball of 642", geodesicSphere(0.2, 3)), polytope("prism of 90", cylinder(0.1, 0.3, 90)),
      polytope("grid of 200", grid(0.3, 10)), polytope("hull of 60", randomHull(60, {0.2, 0.1, 0.15}, 3))};
  Random random(21);
  std::vector<TestShape> others = polytopes;
  for (const std::string& name : boundedShapes()) others.push_back(randomShape(name, random));
  int deep = 0;
  for (const TestShape& first : polytopes)
    for (const TestShape& second : others)
      for (int i = 0; i < trials(30); ++i) {
        CAPTURE(first.name, second.name, i);
        const Isometry3d a = pose(random.rotation(), random.direction());
        // In a third of the cases the axes are parallel, in a third one is turned by almost nothing.
        Isometry3d b = a;
        if (i % 3 != 0) b.linear() = a.linear() * (i % 3 == 1 ? random.rotation() : random.rotation(1e-9));
        b.translation() += (i % 3 == 1 ? random.direction() : a.linear().col(i % 2)) *
                           random.uniform(i % 2 ? 0.05 : 0.4, i % 2 ? 0.4 : 3);
        const ReferenceShape one = first.posed(a), other = second.posed(b);
        const ReferenceAnswer truth =
            referenceDistance(one, other, (b.translation() - a.translation()).cast<long double>());
        const Distance d = distance(first.shape, a, second.shape, b);
        const auto along = static_cast<double>(referenceGap(one, other, d.normal.cast<long double>()));
        if (truth.overlap) {
          ++deep;
          CHECK(std::abs(along - d.distance) <= 1e-14);
          CHECK(d.upper >= static_cast<double>(widestGapOverDirections(one, other, 200)));
          CHECK(d.upper - d.lower <= 2e-6 * -d.lower);
          continue;
        }
        CHECK(d.lower <= static_cast<double>(truth.distance));
        CHECK(d.upper >= static_cast<double>(truth.distance));
        // Faces turned by 1e-9 rad from each other: rounding decides which of their corners are nearest.
        const double turned = i % 3 == 2 ? 1e-9 : 0.0;
        if (turned == 0.0) CHECK(d.status == DistanceStatus::exact);
        CHECK(std::abs(d.distance - static_cast<double>(truth.distance)) <=
              1e-14 + turned);  // of some metres
        CHECK((d.point[1] - d.point[0] - d.distance * d.normal).norm() <= 2e-14 + turned);
        CHECK(std::abs(along - d.distance) <= 1e-14 + turned);  // no part of either body is beyond its point
      }
  CHECK(deep > trials(200));
}

TEST_CASE("a face, an edge or a corner of a polytope is recognised for any number of vertices in it") {
  for (const int sides : {8, 31, 32, 33, 90}) {
    const Cloud cloud = cylinder(0.1, 0.3, sides);
    const Shape prism = Shape::polytopeOf(cloud.data(), static_cast<int>(cloud.size()));
    CAPTURE(sides);
    detail::NormalCone cone;
    REQUIRE(detail::normalCone(prism, Vector3d::UnitZ(), {0, 0, 0.15}, 1e-9, cone));
    CHECK(cone.count == 0);
    CHECK((cone.normal - Vector3d::UnitZ()).norm() <= 1e-12);
    const Vector3d edge = (cloud[1] + cloud[3]).cwiseProduct(Vector3d(1, 1, 0)).normalized();
    REQUIRE(detail::normalCone(prism, (edge + Vector3d::UnitZ()).normalized(), {0, 0, 0.15}, 1e-9, cone));
    CHECK(cone.count == 1);
    REQUIRE(detail::normalCone(prism, Vector3d(1.0, 0.01, 1.0).normalized(), {0, 0, 0.15}, 1e-9, cone));
    CHECK(cone.count == 2);
  }
}

TEST_CASE("a box's normals are those of the polytope of its corners") {
  Random random(21);
  std::array<int, 3> seen{0, 0, 0};
  for (int i = 0; i < 3000; ++i) {
    Vector3d sides;  // some of them are plates and needles
    for (double& side : sides) side = std::pow(10.0, random.uniform(-4, 0));
    if (i % 10 == 0) sides[i / 10 % 3] = 0.0;
    std::array<Vector3d, 8> corner;
    for (std::size_t k = 0; k < 8; ++k)
      corner[k] = 0.5 * sides.cwiseProduct(Vector3d(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1));
    const Shape box = Shape::boxOf(sides), polytope = Shape::polytopeOf(corner.data(), 8);
    // Perpendicular to a face or an edge, or neither, except for a small turn. Sides that are level to 1e-9 m
    // belong to one face.
    Vector3d m = random.direction();
    const int across = i % 3;
    for (int k = 0; k < across; ++k) m[(k + i / 3) % 3] = i % 2 ? 0.0 : 1e-6 * m[(k + i / 3) % 3];
    m.normalize();
    constexpr double kLevel = 1e-9;
    int steepest;
    m.cwiseAbs().maxCoeff(&steepest);
    if (sides[steepest] * std::abs(m[steepest]) <= 4 * kLevel) continue;  // its ends are level too
    if ((sides.cwiseProduct(m.cwiseAbs()).array() - kLevel).abs().minCoeff() < 0.6 * kLevel) continue;
    detail::NormalCone a, b;
    const Vector3d y = polytope.support(m);
    const bool known = detail::normalCone(box, m, y, kLevel, a);
    CAPTURE(i, sides, m);
    REQUIRE(known == detail::normalCone(polytope, m, y, kLevel, b));
    if (!known) continue;
    REQUIRE(a.count == b.count);
    ++seen[static_cast<std::size_t>(a.count)];
    CHECK((a.normal - b.normal).norm() < 1e-12);  // for differences of corners, divided by 1e-4 m
    if (a.count == 1) CHECK(a.way[0].cross(b.way[0]).norm() < 1e-12);
    for (int k = 0; k < a.count; ++k)
      CHECK(std::abs(a.way[static_cast<std::size_t>(k)].dot(a.normal)) < 1e-12);
  }
  CHECK((seen[0] > 300 && seen[1] > 300 && seen[2] > 300));
}
