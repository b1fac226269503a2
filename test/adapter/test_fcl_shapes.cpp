// An STP-BV against FCL's other geometries through the drop-in: shapes,
// meshes of every bounding volume, octrees.
#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/geometric_shape_to_BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/plane.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/geometry/shape/triangle_p.h>
#if FCL_HAVE_OCTOMAP
#include <fcl/geometry/octree/octree.h>
#endif

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/distance/distance.h"
#include "test/reference/fcl_bodies.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

TEST_CASE("every FCL shape is answered exactly, in both orders alike") {
  const auto body = link();
  const std::vector<std::pair<std::shared_ptr<fcl::CollisionGeometryd>, Shape>> shapes{
      {std::make_shared<fcl::Sphered>(0.1), Shape::sphere(0.1)},
      {std::make_shared<fcl::Capsuled>(0.1, 0.3), Shape::capsule(0.1, 0.3)},
      {std::make_shared<fcl::Ellipsoidd>(0.1, 0.2, 0.3), Shape::ellipsoidOf({0.1, 0.2, 0.3})},
      {std::make_shared<fcl::Boxd>(0.1, 0.2, 0.3), Shape::boxOf({0.1, 0.2, 0.3})},
      {std::make_shared<fcl::Cylinderd>(0.1, 0.3), Shape::cylinderOf(0.1, 0.3)},
      {std::make_shared<fcl::Coned>(0.1, 0.3), Shape::coneOf(0.1, 0.3)},
      {std::make_shared<fcl::Halfspaced>(Vector3d(0, 0, 1), 0.1), Shape::halfspaceOf({0, 0, 1}, 0.1)},
      {std::make_shared<fcl::Planed>(Vector3d(0, 0, 1), 0.1), Shape::planeOf({0, 0, 1}, 0.1)},
      {std::make_shared<fcl::TrianglePd>(Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)),
       Shape::triangleOf({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}};
  Random random(2);
  for (const auto& [geometry, shape] : shapes)
    for (int i = 0; i < 100; ++i) {
      CAPTURE(static_cast<int>(geometry->getNodeType()), i);
      const Isometry3d a = pose(random.rotation(), random.direction());
      const Isometry3d b =
          pose(random.rotation(), a.translation() + random.uniform(0.2, 1) * random.direction());
      const DistanceAnswer d = distance(*body, a, *geometry, b), e = distance(*geometry, b, *body, a);
      const Distance truth = distance(body->volume(), a, shape, b);
      CHECK(d.distance == truth.distance);
      CHECK(d.status == truth.status);
      CHECK(e.distance == d.distance);
      CHECK(e.normal == -d.normal);
      CHECK(e.points[0] == d.points[1]);
      CHECK(e.gradient[0] == d.gradient[1]);
      CHECK(d.continuous);
      CHECK(isFartherThan(d.distance - 1e-9, *body, a, *geometry, b));
      CHECK(collides(*body, a, *geometry, b, d.distance + 1e-9));
    }
}

TEMPLATE_TEST_CASE("a mesh of any bounding volume gives the minimum over its triangles", "", fcl::AABBd,
                   fcl::OBBd, fcl::RSSd, fcl::kIOSd, fcl::OBBRSSd, (fcl::KDOP<double, 16>),
                   (fcl::KDOP<double, 18>), (fcl::KDOP<double, 24>)) {
  const auto mesh = bumpyGround<TestType>(24, 0.05);
  const auto body = link();
  Random random(3);
  for (int i = 0; i < 12; ++i) {
    const Isometry3d ground = pose(random.rotation(), random.direction());
    const Isometry3d at = ground * pose(random.rotation(), {random.uniform(-1, 1), random.uniform(-1, 1),
                                                            random.uniform(0.2, 1)});
    std::vector<double> all;
    for (int t = 0; t < mesh->num_tris; ++t) {
      const fcl::Triangle& v = mesh->tri_indices[t];
      all.push_back(
          distance(body->volume(), at,
                   Shape::triangleOf(mesh->vertices[v[0]], mesh->vertices[v[1]], mesh->vertices[v[2]]),
                   ground)
              .distance);
    }
    const DistanceAnswer d = distance(*body, at, *mesh, ground), e = distance(*mesh, ground, *body, at);
    const double least = *std::min_element(all.begin(), all.end());
    CHECK(std::abs(d.distance - least) <= 1e-14);
    REQUIRE(d.element[1] >= 0);
    CHECK(std::abs(all[static_cast<std::size_t>(d.element[1])] - least) <= 1e-14);
    all.erase(all.begin() + d.element[1]);
    CHECK(std::abs(d.runnerUp - *std::min_element(all.begin(), all.end())) <= 1e-14);
    CHECK(e.distance == d.distance);
    CHECK(e.element[0] == d.element[1]);
    CHECK_FALSE(d.continuous);
    CHECK(toFclResult(d).b2 == d.element[1]);
  }
}

#if FCL_HAVE_OCTOMAP
TEST_CASE("an octree gives the minimum over its occupied cells") {
  auto tree = std::make_shared<octomap::OcTree>(0.05);
  Random random(5);
  for (int i = 0; i < 300; ++i)
    tree->updateNode(octomap::point3d(static_cast<float>(random.uniform(-0.5, 0.5)),
                                      static_cast<float>(random.uniform(-0.5, 0.5)),
                                      static_cast<float>(random.uniform(-0.5, 0.5))),
                     i % 5 != 0);
  const fcl::OcTreed cells(tree);
  const auto body = link();
  for (int i = 0; i < 20; ++i) {
    const Isometry3d at = pose(random.rotation(), random.uniform(0.9, 1.5) * random.direction());
    const Isometry3d ground = pose(random.rotation(), {0, 0, 0});
    std::vector<double> all;
    for (const auto& cell : cells.toBoxes()) {
      Isometry3d where = ground;
      where.translation() = ground * Vector3d(cell[0], cell[1], cell[2]);
      all.push_back(distance(body->volume(), at, Shape::boxOf(Vector3d::Constant(cell[3])), where).distance);
    }
    std::sort(all.begin(), all.end());
    const double least = all[0];
    const DistanceAnswer d = distance(*body, at, cells, ground);
    // Compilers evaluate the arguments of pose() in different orders, so some scenes are deeper than the
    // margin.
    CHECK(d.status == (least > -body->volume().radii().r ? DistanceStatus::exact : DistanceStatus::local));
    CHECK(std::abs(d.distance - least) <= 1e-12);
    fcl::AABBd cell;  // FCL finds the cell by its id
    CHECK(cells.getNodeByQueryCellId(d.element[1], ground.inverse() * d.points[1], &cell) != nullptr);
    CHECK(std::abs(d.runnerUp - all[1]) <= 1e-12);
    CHECK(distance(cells, ground, *body, at).distance == d.distance);
  }
}
#endif

TEST_CASE("two shapes without an STP-BV are measured exactly while they are apart") {
  // A sphere is also the STP-BV of one point, which is computed in another way and can be compared.
  const fcl::Sphered ball(0.1);
  const StpBvGeometry point(StpBv::build({{0, 0, 0}}, {0.1, 10}));
  const std::vector<std::shared_ptr<fcl::CollisionGeometryd>> shapes{
      std::make_shared<fcl::Sphered>(0.2),        std::make_shared<fcl::Capsuled>(0.1, 0.4),
      std::make_shared<fcl::Boxd>(0.3, 0.2, 0.1), std::make_shared<fcl::Cylinderd>(0.2, 0.3),
      std::make_shared<fcl::Coned>(0.2, 0.3),     std::make_shared<fcl::Ellipsoidd>(0.1, 0.2, 0.3)};
  Random random(9);
  for (const auto& shape : shapes)
    for (int i = 0; i < 300; ++i) {
      CAPTURE(static_cast<int>(shape->getNodeType()), i);
      const Isometry3d a = pose(random.rotation(), random.direction());
      const Isometry3d b =
          pose(random.rotation(), a.translation() + random.uniform(0.5, 1) * random.direction());
      const DistanceAnswer truth = distance(*shape, a, point, b), d = distance(*shape, a, ball, b);
      CHECK(std::abs(d.distance - truth.distance) <= 1e-12);
      CHECK(d.lower <= truth.distance + 1e-14);
      CHECK(d.upper >= truth.distance - 1e-14);
      // The ball's path has a margin of 0.1 m. Without a margin, the normal's error would be rounding divided
      // by the distance.
      CHECK((d.normal - truth.normal).norm() <= 1e-13);
      CHECK_FALSE(d.continuous);
      CHECK(d.status == DistanceStatus::exact);
    }
  const fcl::Boxd first(0.2, 0.3, 0.4), second(0.4, 0.1, 0.2);
  for (int i = 0; i < 300; ++i) {
    const Isometry3d a = pose(random.rotation(), random.direction());
    const Isometry3d b =
        pose(random.rotation(), a.translation() + random.uniform(0.5, 1) * random.direction());
    const DistanceAnswer d = distance(first, a, second, b), e = distance(second, b, first, a);
    CHECK(d.status == DistanceStatus::exact);
    CHECK(std::abs(d.distance - e.distance) <= 1e-14);
    CHECK((d.points[1] - d.points[0] - d.distance * d.normal).norm() <= 1e-13);
  }
}

TEST_CASE("nothing to measure to has no answer") {
  const auto body = link();
  const Isometry3d at = Isometry3d::Identity();
  CHECK(distance(*body, at, fcl::BVHModel<fcl::OBBRSSd>(), at).status == DistanceStatus::invalid);
  CHECK(collides(*body, at, fcl::BVHModel<fcl::OBBRSSd>(), at));
}

TEST_CASE("a plane whose normal is a little longer than 1 stands where normal.x = offset, or has no answer") {
  // A million metres from the origin, where 4e-7 of the offset is 0.4 m. FCL's constructor normalises
  // normals, but its fields are public.
  const double offset = 1e6;
  const Isometry3d here = Isometry3d::Identity();
  for (const double length : {1 + 4e-7, 1 - 4e-7, 1 + 1e-12, 1 + 1e-3, 0.0}) {
    CAPTURE(length);
    fcl::Halfspaced ground;
    fcl::Planed sheet;
    ground.n = sheet.n = Vector3d(0, 0, length);
    ground.d = sheet.d = offset;
    const double height = offset / length;
    const Isometry3d above = pose(Eigen::Matrix3d::Identity(), {0.1, 0.2, offset + 5});
    const fcl::Boxd crate(0.2, 0.4, 1);
    const StpBvGeometry point(StpBv::build({{0, 0, 0}}, {0.1, 10}));
    for (const fcl::CollisionGeometryd* flat : {static_cast<const fcl::CollisionGeometryd*>(&ground),
                                                static_cast<const fcl::CollisionGeometryd*>(&sheet)}) {
      const DistanceAnswer d = distance(*flat, here, crate, above), e = distance(*flat, here, point, above);
      if (std::abs(length - 1) > 1e-4) {
        CHECK((d.status == DistanceStatus::invalid && e.status == DistanceStatus::invalid));
        continue;
      }
      CHECK(std::abs(d.distance - (offset + 5 - 0.5 - height)) <= 1e-9);
      CHECK(std::abs(e.distance - (offset + 5 - 0.1 - height)) <= 1e-9);
      CHECK((d.lower <= offset + 4.5 - height && d.upper >= offset + 4.5 - height));
    }
  }
}
