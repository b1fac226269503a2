// Sizes and poses that describe no body: `invalid` for every pair of types alike, and
// libccd's assertions are never reached.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/geometric_shape_to_BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/geometry/shape/triangle_p.h>

#include <catch2/catch.hpp>
#include <limits>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

std::vector<Geometry> shapesOfSize(double x) {
  return {std::make_shared<fcl::Boxd>(x, 0.1, 0.1),
          std::make_shared<fcl::Cylinderd>(x, 0.1),
          std::make_shared<fcl::Cylinderd>(0.1, x),
          std::make_shared<fcl::Coned>(x, 0.1),
          std::make_shared<fcl::Coned>(0.1, x),
          std::make_shared<fcl::Ellipsoidd>(0.1, x, 0.1),
          std::make_shared<fcl::Capsuled>(x, 0.1),
          std::make_shared<fcl::Capsuled>(0.1, x),
          std::make_shared<fcl::Sphered>(x),
          std::make_shared<fcl::TrianglePd>(Vector3d(0, 0, x), Vector3d(0.1, 0, 0), Vector3d(0, 0.1, 0))};
}

template <typename BV>
Geometry meshOfBox(double side) {
  auto mesh = std::make_shared<fcl::BVHModel<BV>>();
  fcl::generateBVHModel(*mesh, fcl::Boxd(0.2, 0.3, 0.4), Isometry3d::Identity());
  for (int i = 0; i < mesh->num_vertices; ++i)
    if (mesh->vertices[i].x() > 0) mesh->vertices[i].x() = side;
  return mesh;
}

std::vector<Geometry> soundGeometries() {
  return {std::make_shared<fcl::Boxd>(0.1, 0.2, 0.3),
          std::make_shared<fcl::Coned>(0.1, 0.2),
          std::make_shared<fcl::Ellipsoidd>(0.1, 0.2, 0.3),
          std::make_shared<StpBvGeometry>(StpBv::build(box(0.1, 0.2, 0.3), {0.01, 10})),
          meshOfBox<fcl::OBBRSSd>(0.1),
          meshOfBox<fcl::RSSd>(0.1)};
}

void checkInvalid(const fcl::CollisionGeometryd& a, const Isometry3d& poseA, const fcl::CollisionGeometryd& b,
                  const Isometry3d& poseB) {
  const DistanceAnswer d = distance(a, poseA, b, poseB), e = distance(b, poseB, a, poseA);
  CHECK(d.status == DistanceStatus::invalid);
  CHECK(e.status == DistanceStatus::invalid);
  CHECK_FALSE(isFartherThan(0.0, a, poseA, b, poseB));
}

}  // namespace

TEST_CASE("A shape with a size that is no number, infinite or negative has no distance to anything") {
  const double infinity = std::numeric_limits<double>::infinity();
  const Isometry3d there = pose(Eigen::Matrix3d::Identity(), {1, 0.1, 0.2});
  for (const double x : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity, -0.1})
    for (const Geometry& bad : shapesOfSize(x)) {
      if (x == -0.1 && bad->getNodeType() == fcl::GEOM_TRIANGLE)
        continue;  // a corner below its frame's origin
      for (const Geometry& other : soundGeometries()) {
        CAPTURE(x, bad->getNodeType(), other->getNodeType());
        checkInvalid(*bad, Isometry3d::Identity(), *other, there);
        checkInvalid(*bad, there, *bad, Isometry3d::Identity());
      }
    }
}

TEST_CASE("A mesh with a corner that is no number has no distance to a shape") {
  const Isometry3d there = pose(Eigen::Matrix3d::Identity(), {1, 0.1, 0.2});
  const Geometry bad = meshOfBox<fcl::OBBRSSd>(std::numeric_limits<double>::quiet_NaN());
  const fcl::Boxd box(0.1, 0.2, 0.3);
  CHECK(distance(*bad, Isometry3d::Identity(), box, there).status == DistanceStatus::invalid);
  CHECK(distance(box, there, *bad, Isometry3d::Identity()).status == DistanceStatus::invalid);
}

TEST_CASE("A pose that is no rigid motion has no answer, for every pair of types") {
  Isometry3d stretched = pose(Eigen::Matrix3d(2.0 * Eigen::Matrix3d::Identity()), {1, 0, 0}),
             mirrored = pose(Eigen::Matrix3d(-Eigen::Matrix3d::Identity()), {1, 0, 0}), nowhere = stretched;
  nowhere.linear().setIdentity();
  nowhere.translation().x() = std::numeric_limits<double>::infinity();
  for (const Geometry& a : soundGeometries())
    for (const Geometry& b : soundGeometries())
      for (const Isometry3d& bad : {stretched, mirrored, nowhere}) {
        CAPTURE(a->getNodeType(), b->getNodeType());
        checkInvalid(*a, Isometry3d::Identity(), *b, bad);
      }
}
