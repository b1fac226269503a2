// Sizes, corners and poses that describe no body must give `invalid` for every pair of types, and must not
// reach libccd's assertions.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/geometric_shape_to_BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/geometry/shape/triangle_p.h>

#include <catch2/catch.hpp>
#include <limits>

#include "fcl_stpbv/adapter/collide.h"
#include "fcl_stpbv/adapter/continuous_collide.h"
#include "fcl_stpbv/adapter/fcl_distance.h"
#include "test/reference/fcl_bodies.h"
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

/// Bumpy ground of triangles or points with one coordinate of one corner set to `x`. It is either built by
/// FCL, whose boxes then may or may not hide the value, or changed in place, so that the boxes do not contain
/// it.
template <typename BV>
std::shared_ptr<fcl::BVHModel<BV>> groundWith(double x, int corner, bool built, bool cloud = false) {
  const auto ground = bumpyGround<fcl::AABBd>(6, 0.1);
  std::vector<Vector3d> points(ground->vertices, ground->vertices + ground->num_vertices);
  const std::vector<fcl::Triangle> triangles(ground->tri_indices, ground->tri_indices + ground->num_tris);
  if (built) points[static_cast<std::size_t>(corner)][corner % 3] = x;
  auto mesh = std::make_shared<fcl::BVHModel<BV>>();
  mesh->beginModel();
  cloud ? mesh->addSubModel(points) : mesh->addSubModel(points, triangles);
  mesh->endModel();
  mesh->vertices[corner][corner % 3] = x;
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

/// Checks that no query about the pair gives an answer as if the pair were clear or its place of contact were
/// known.
void checkUnknown(const fcl::CollisionGeometryd& a, const Isometry3d& poseA, const fcl::CollisionGeometryd& b,
                  const Isometry3d& poseB) {
  CHECK(distance(a, poseA, b, poseB).status == DistanceStatus::invalid);
  fcl::DistanceResultd least;
  CHECK(fcl_stpbv::distance(&a, poseA, &b, poseB, fcl::DistanceRequestd(), least) == -1);
  for (const double x : {-1e3, -0.1, 0.0, 0.1}) CHECK_FALSE(isFartherThan(x, a, poseA, b, poseB));
  for (const bool withContact : {true, false}) {
    fcl::CollisionResultd found;
    REQUIRE(fcl_stpbv::collide(&a, poseA, &b, poseB, fcl::CollisionRequestd(100, withContact), found) == 1);
    if (withContact) CHECK(found.getContact(0).penetration_depth == std::numeric_limits<double>::infinity());
  }
  for (const auto type : {fcl::CCDM_TRANS, fcl::CCDM_LINEAR, fcl::CCDM_SCREW}) {
    const fcl::ContinuousCollisionRequestd request(10, 1e-4, type);
    fcl::ContinuousCollisionResultd found;
    CHECK(fcl_stpbv::continuousCollide(&a, poseA, poseA, &b, poseB, poseB, request, found) == -1);
    CHECK((found.is_collide && found.time_of_contact == 0));
  }
}

}  // namespace

TEST_CASE("A shape with a size that is no number, infinite or negative has no distance to anything") {
  const double infinity = std::numeric_limits<double>::infinity();
  const Isometry3d there = pose(Eigen::Matrix3d::Identity(), {1, 0.1, 0.2});
  for (const double x : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity, -0.1})
    for (const Geometry& bad : shapesOfSize(x)) {
      if (x == -0.1 && bad->getNodeType() == fcl::GEOM_TRIANGLE)
        continue;  // a corner below the frame's origin
      for (const Geometry& other : soundGeometries()) {
        CAPTURE(x, bad->getNodeType(), other->getNodeType());
        checkInvalid(*bad, Isometry3d::Identity(), *other, there);
        checkInvalid(*bad, there, *bad, Isometry3d::Identity());
      }
    }
}

TEST_CASE("A mesh with a corner that is no number, wherever it is, has no answer to any question") {
  const double infinity = std::numeric_limits<double>::infinity();
  std::vector<Geometry> others = soundGeometries();
  others.push_back(std::make_shared<fcl::Halfspaced>(Vector3d::UnitZ(), -0.3));
  const Isometry3d here = Isometry3d::Identity();
  int asked = 0;
  for (const double x : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity, 1e200})
    for (const int corner :
         {0, 1, 2, 17, 24, 46, 47, 48})  // of 49; also the last ones, which do not fill a register
      for (const Geometry& bad : {Geometry(groundWith<fcl::OBBRSSd>(x, corner, false)),
                                  Geometry(groundWith<fcl::RSSd>(x, corner, false, true)),
                                  Geometry(groundWith<fcl::AABBd>(x, corner, true)),
                                  Geometry(groundWith<fcl::KDOP<double, 16>>(x, corner, true))}) {
        CAPTURE(x, corner, bad->getNodeType());
        CHECK_FALSE(hasFiniteCorners(*bad));
        const Geometry& other = others[static_cast<std::size_t>(++asked) % others.size()];
        // On the ground, and where the boxes alone would decide.
        for (const Vector3d& place : {Vector3d(0.1, 0.2, 0.05), Vector3d(0.3, 0, 4)}) {
          const Isometry3d there = pose(Eigen::Matrix3d::Identity(), place);
          CAPTURE(other->getNodeType(), place.transpose());
          checkUnknown(*bad, here, *other, there);
          checkUnknown(*other, there, *bad, here);
        }
      }
}

TEST_CASE("A caller that has looked at the corners gets the same answers without another look") {
  const auto ground = bumpyGround<fcl::OBBRSSd>(6, 0.1);
  CHECK(hasFiniteCorners(*ground));
  const Isometry3d here = Isometry3d::Identity();
  QueryContext looked;
  looked.finite = true;
  for (const Geometry& other : soundGeometries()) {
    CHECK(hasFiniteCorners(*other));
    for (const double height : {0.05, 0.5}) {
      CAPTURE(other->getNodeType(), height);
      const Isometry3d there = pose(Eigen::Matrix3d::Identity(), {0.1, 0.2, height});
      const DistanceAnswer d = distance(*ground, here, *other, there);
      CHECK(d.status != DistanceStatus::invalid);
      CHECK(d.distance == distance(*ground, here, *other, there, looked).distance);
      for (const double x : {-0.1, 0.0, 0.1})
        CHECK(isFartherThan(x, *ground, here, *other, there) ==
              isFartherThan(x, *ground, here, *other, there, looked));
      fcl::CollisionResultd found, again;
      const fcl::CollisionRequestd request(100, true);
      CHECK(fcl_stpbv::collide(ground.get(), here, other.get(), there, request, found) ==
            fcl_stpbv::collide(ground.get(), here, other.get(), there, request, again, looked));
    }
  }
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

TEST_CASE(
    "A motion whose first pose is rigid to 1e-6 only is that of the nearest rotation: free where it stays "
    "apart") {
  const fcl::Boxd bar(1, 0.1, 0.2), wall(1, 1, 1);
  Random random(5);
  int met = 0;
  for (int i = 0; i < 300; ++i) {
    SteadyMotion motion;
    motion.begin = pose(random.rotation(), 1.5 * random.direction());
    for (int k = 0; k < 9; ++k) motion.begin.linear()(k % 3, k / 3) += random.uniform(-5e-7, 5e-7);
    motion.linear = -random.uniform(0, 0.3) * motion.begin.translation();
    motion.angular = random.uniform(0, 1) * random.direction();
    const auto gap = [&](double t) { return distance(bar, motion.at(t), wall, at(0, 0, 0)); };
    // A margin that is reached only at the very end of the motion.
    const double margin = gap(1).upper + 1e-9;
    if (!(gap(0.99).distance > margin && gap(0).distance > margin)) continue;
    ++met;
    CHECK(firstContact(bar, motion, wall, {}, {margin, 1e-6}).verdict != MotionVerdict::free);
  }
  CHECK(met > 200);
}
