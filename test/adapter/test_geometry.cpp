// An STP-BV as FCL's geometry. Its polyhedron is convex, closed and consists of the volume's vertices.
// Extreme vertices are compared with a search over all vertices. Its box touches the smooth surface. Its
// features name patches. Plain FCL accepts it.
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "fcl_stpbv/convex/hull_graph.h"
#include "fcl_stpbv/error.h"
#include "test/reference/fcl_bodies.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;

namespace {

std::vector<Cloud> shapes() {
  return {box(0.2, 0.3, 0.4), plate(0.3, 0.2),        needle(0.5),
          cylinder(0.1, 0.4), geodesicSphere(0.2, 2), randomHull(300, {0.3, 0.2, 0.1}, 5)};
}

std::vector<Cloud> degenerateShapes() {
  return {{{0.1, 0.2, 0.3}},
          {{0.1, 0, 0}, {0.3, 0, 0.1}},
          {{0, 0, 0}, {0.2, 0, 0}, {0, 0.3, 0}},
          {{0.1, 0.1, 0.2}, {-0.1, 0.1, 0.2}, {-0.1, -0.1, 0.2}, {0.1, -0.1, 0.2}}};
}

/// Height of the highest vertex along `n`, by a search over all vertices.
double heightOf(const HullGraph& hull, const Vector3d& n) {
  double best = -1e300;
  for (int v = 0; v < hull.vertexCount(); ++v) best = std::max(best, n.dot(hull.point(v)));
  return best;
}

}  // namespace

TEST_CASE("FCL's polyhedron is convex, closed and made of the volume's own vertices") {
  for (const Cloud& cloud : shapes()) {
    const auto geometry = geometryOf(cloud);
    const auto& vertices = geometry->getVertices();
    const HullGraph& hull = geometry->hull();
    REQUIRE(static_cast<int>(vertices.size()) == hull.vertexCount());
    CHECK(hull.vertexCount() - hull.edgeCount() + hull.faceCount() == 2);
    for (int v = 0; v < hull.vertexCount(); ++v)
      CHECK(
          vertices[static_cast<std::size_t>(v)] ==
          geometry->volume().vertices()[static_cast<std::size_t>(geometry->patchOf({PatchKind::vertex, v}))]);
    for (int f = 0; f < hull.faceCount(); ++f) {
      const Vector3d& n = hull.faceNormal(f);
      const double height = n.dot(hull.point(hull.faces()[static_cast<std::size_t>(f)][0]));
      CHECK(heightOf(hull, n) <= height + 1e-12);
      for (const int v : hull.faces()[static_cast<std::size_t>(f)])
        CHECK(std::abs(n.dot(hull.point(v)) - height) <= 1e-12);
    }
    // FCL's own check of a mesh: closed, each vertex in a face.
    const auto faces = std::make_shared<const std::vector<int>>(geometry->getFaces());
    const auto points = std::make_shared<const std::vector<Vector3d>>(vertices);
    CHECK_NOTHROW(fcl::Convexd(points, geometry->getFaceCount(), faces, true));
    CHECK(geometry->computeVolume() > 0);
  }
}

TEST_CASE("climbing the hull finds the extreme vertex from anywhere") {
  Random random(3);
  std::vector<Cloud> clouds = shapes();
  clouds.push_back(geodesicSphere(0.2, 4));
  clouds.push_back(cylinder(0.1, 0.4, 400));
  for (const Cloud& cloud : clouds) {
    const HullGraph hull(cloud);
    for (int i = 0; i < 500; ++i) {
      const Vector3d n = random.direction() * std::exp(random.uniform(-5, 5));
      const double expected = heightOf(hull, n);
      for (const int from : {-1, random.below(hull.vertexCount())})
        REQUIRE(std::abs(n.dot(hull.point(hull.extremeVertex(n, from))) - expected) <= 1e-15 * n.norm());
    }
  }
}

TEST_CASE("the bounding box touches the smooth surface on all six sides and holds it when rotated") {
  Random random(5);
  std::vector<Cloud> clouds = shapes();
  for (const Cloud& cloud : degenerateShapes()) clouds.push_back(cloud);
  for (const Cloud& cloud : clouds) {
    const auto geometry = geometryOf(cloud, 0.02, 2.0);
    const StpBv& volume = geometry->volume();
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(geometry->aabb_local.max_[axis] == volume.support(Vector3d::Unit(axis)));
      CHECK(geometry->aabb_local.min_[axis] == -volume.support(-Vector3d::Unit(axis)));
    }
    fcl::CollisionObjectd object(geometry);
    for (int i = 0; i < 100; ++i) {
      object.setTransform(pose(random.rotation(), random.direction()));
      object.computeAABB();
      for (int k = 0; k < 20; ++k) {
        const Vector3d x = object.getTransform() * volume.surfacePoint(random.direction());
        REQUIRE((x - object.getAABB().min_).minCoeff() >= -1e-12);
        REQUIRE((object.getAABB().max_ - x).minCoeff() >= -1e-12);
      }
    }
  }
}

TEST_CASE("features of the hull name patches of the same name") {
  for (const Cloud& cloud : shapes()) {
    const auto geometry = geometryOf(cloud);
    const StpBv& volume = geometry->volume();
    const HullGraph& hull = geometry->hull();
    int same = 0;
    for (int e = 0; e < hull.edgeCount(); ++e) {
      const int patch = geometry->patchOf({PatchKind::edge, e});
      REQUIRE(patch >= 0);
      REQUIRE(patch < volume.patchCount());
      if (volume.kind(patch) != PatchKind::edge) continue;
      // The patch's axis must be parallel to the edge it is named after, because its circle lies across the
      // edge.
      const auto [a, b] = hull.edges()[static_cast<std::size_t>(e)];
      const Vector3d u = (hull.point(b) - hull.point(a)).normalized();
      if (std::abs(std::abs(u.dot(volume.patch(patch).axis)) - 1) <= 1e-12) ++same;
    }
    CHECK(same >= 0.9 * hull.edgeCount());
    for (int f = 0; f < hull.faceCount(); ++f) {
      const int patch = geometry->patchOf({PatchKind::face, f});
      REQUIRE(patch >= 0);
      REQUIRE(patch < volume.patchCount());
    }
    CHECK(geometry->patchOf({}) == -1);
  }
}

TEST_CASE("a volume without volume is still a geometry that FCL takes") {
  for (const Cloud& cloud : degenerateShapes()) {
    CAPTURE(cloud.size());
    const auto geometry = geometryOf(cloud);
    CHECK(geometry->getVertices().size() == cloud.size());
    fcl::CollisionObjectd object(geometry, pose(Eigen::Matrix3d::Identity(), {0, 0, 1}));
    const auto other = std::make_shared<fcl::Boxd>(0.2, 0.2, 0.2);
    fcl::CollisionObjectd otherObject(other, pose(Eigen::Matrix3d::Identity(), {0, 0, 2}));
    fcl::DistanceRequestd request;
    fcl::DistanceResultd result;
    CHECK(fcl::distance(&object, &otherObject, request, result) > 0.3);
  }
}

TEST_CASE("plain FCL calls see the polyhedron") {
  const auto cube = geometryOf(box(0.2, 0.2, 0.2));
  fcl::CollisionObjectd a(cube), b(cube, pose(Eigen::Matrix3d::Identity(), {0.5, 0.03, 0.02}));
  fcl::DistanceRequestd request;
  fcl::DistanceResultd result;
  CHECK(fcl::distance(&a, &b, request, result) == Approx(0.3).margin(1e-9));
  CHECK(asStpBv(result.o1) == cube.get());

  fcl::CollisionRequestd ask;
  fcl::CollisionResultd answer;
  CHECK(fcl::collide(&a, &b, ask, answer) == 0);
  b.setTranslation({0.15, 0, 0});
  CHECK(fcl::collide(&a, &b, ask, answer) > 0);
  CHECK(cube->getNodeType() == fcl::GEOM_CONVEX);
  CHECK(cube->getUserData() == nullptr);
}

TEST_CASE("only STP-BV geometries are recognised") {
  CHECK(asStpBv(nullptr) == nullptr);
  CHECK(asStpBv(std::make_shared<fcl::Boxd>(1, 1, 1).get()) == nullptr);
  const auto cube = geometryOf(box(0.2, 0.2, 0.2));
  CHECK(asStpBv(std::make_shared<fcl::Convexd>(*cube).get()) == nullptr);
  CHECK(asStpBv(cube.get()) == cube.get());
}

TEST_CASE("a geometry of no volume, or a hull of no cloud, is refused with a reason") {
  CHECK_THROWS_AS(StpBvGeometry(nullptr), Error);
  const StpBvGeometry whole(StpBv::build(box(0.1, 0.2, 0.3)));
  CHECK_THROWS_AS(StpBvGeometry(nullptr, std::make_shared<const HullGraph>(whole.hull())), Error);
  CHECK_THROWS_AS(StpBvGeometry(StpBv::build(box(0.1, 0.2, 0.3)), nullptr), Error);
  CHECK_THROWS_AS(HullGraph(Cloud{}), Error);
  CHECK_THROWS_AS(HullGraph(Cloud{{0, std::nan(""), 0}}), Error);
}
