// States of FCL's objects that their types do not show: boxes merged after a mesh's vertices have moved,
// meshes built half, clouds with room for triangles, cells far from their tree's origin, and motions about a
// point that was never set.
#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/geometric_shape_to_BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/motion/interp_motion.h>
#include <fcl/math/motion/translation_motion.h>
#if FCL_HAVE_OCTOMAP
#include <fcl/geometry/octree/octree.h>
#endif

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <new>
#include <type_traits>

#include "fcl_stpbv/adapter/collide.h"
#include "fcl_stpbv/adapter/continuous_collide.h"
#include "fcl_stpbv/adapter/element_tree.h"
#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/fcl_hessian.h"
#include "test/reference/fcl_bodies.h"
#include "test/reference/reference.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

struct Soup {
  std::vector<Vector3d> points;
  std::vector<fcl::Triangle> triangles;
};

Soup soupOf(std::size_t count, Random& random) {
  Soup soup;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d middle = random.uniform(0, 1) * random.direction();
    for (int j = 0; j < 3; ++j) soup.points.push_back(middle + random.uniform(0, 0.3) * random.direction());
    soup.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  return soup;
}

template <typename BV>
void checkFresh(const fcl::BVHModel<BV>& mesh) {
  CAPTURE(mesh.num_tris);
  CHECK_FALSE(detail::ElementTree(mesh).merged());
}

bool touch(const fcl::CollisionGeometryd& a, const fcl::CollisionGeometryd& b, const Isometry3d& poseB) {
  fcl::CollisionResultd result;
  return collide(&a, Isometry3d::Identity(), &b, poseB, fcl::CollisionRequestd(1), result) > 0;
}

}  // namespace

TEMPLATE_TEST_CASE("a mesh whose vertices FCL has moved is met wherever it is", "", fcl::AABBd, fcl::OBBd,
                   fcl::RSSd, fcl::kIOSd, fcl::OBBRSSd, (fcl::KDOP<double, 16>), (fcl::KDOP<double, 24>)) {
  Random random(11);
  const fcl::Sphered ball(0.01);
  const auto body = link();
  for (std::size_t count = 1; count <= 12; ++count)
    for (const bool replaced : {true, false})
      for (int i = 0; i < 10; ++i) {
        const Soup soup = soupOf(count, random);
        const Isometry3d by = pose(random.rotation(), 0.5 * random.direction());
        std::vector<Vector3d> moved;
        for (const Vector3d& p : soup.points) moved.push_back(by * p);
        const auto mesh = meshOf<TestType>(soup.points, soup.triangles);
        if (replaced) {
          mesh->beginReplaceModel();
          mesh->replaceSubModel(moved);
          CHECK(distance(*mesh, by, ball, by).status == DistanceStatus::invalid);  // half built
          mesh->endReplaceModel();
        } else {
          mesh->beginUpdateModel();
          mesh->updateSubModel(moved);
          mesh->endUpdateModel();
        }
        CAPTURE(count, replaced, i);
        for (const Vector3d& corner : moved) {
          const Isometry3d there = pose(Eigen::Matrix3d::Identity(), corner);
          const DistanceAnswer d = distance(*mesh, Isometry3d::Identity(), ball, there);
          CHECK(d.distance <= -0.01 + 1e-15);  // the ball's depth, or more in another triangle
          CHECK(d.lower <= -0.01);
          CHECK(touch(*mesh, ball, there));
          CHECK_FALSE(isFartherThan(0, *mesh, Isometry3d::Identity(), ball, there));
          SteadyMotion still, past;
          past.linear = {1e-3, 0, 0};
          past.begin.translation() = corner - 0.5 * past.linear;
          CHECK(firstContact(*mesh, still, ball, past).verdict == MotionVerdict::contact);
        }
        const Isometry3d at = pose(random.rotation(), 2 * random.direction());
        const auto fresh = meshOf<TestType>(moved, soup.triangles);
        CHECK(std::abs(distance(*body, at, *mesh, Isometry3d::Identity()).distance -
                       distance(*body, at, *fresh, Isometry3d::Identity()).distance) <= 1e-14);
        CHECK(touch(*mesh, *fresh, Isometry3d::Identity()));
      }
}

TEMPLATE_TEST_CASE("moved triangles whose corners lie on a line are met wherever they are", "", fcl::OBBd,
                   fcl::RSSd, fcl::kIOSd, fcl::OBBRSSd) {
  Random random(12);
  const fcl::Sphered ball(0.01);
  for (std::size_t count = 1; count <= 8; ++count)
    for (int i = 0; i < 40; ++i) {
      Soup soup = soupOf(count, random);
      for (std::size_t t = 0; t < count; ++t) {
        const auto corner = [&](std::size_t k) -> Vector3d& { return soup.points[3 * t + k]; };
        if (random.uniform(0, 1) < 0.3) continue;
        corner(2) = corner(0) + random.uniform(0, 1) * (corner(1) - corner(0));
        if (random.uniform(0, 1) < 0.3) corner(1) = corner(0);
      }
      const auto mesh = meshOf<TestType>(soup.points, soup.triangles);
      checkFresh(*mesh);
      const Vector3d by = random.direction();
      for (Vector3d& p : soup.points) p += by;
      if (i % 2 == 0) {
        mesh->beginReplaceModel();
        mesh->replaceSubModel(soup.points);
        mesh->endReplaceModel();
      } else {
        mesh->beginUpdateModel();
        mesh->updateSubModel(soup.points);
        mesh->endUpdateModel();
      }
      CAPTURE(count, i);
      for (const Vector3d& corner : soup.points) {
        const Isometry3d there = pose(Eigen::Matrix3d::Identity(), corner);
        CHECK(distance(*mesh, Isometry3d::Identity(), ball, there).lower <= -0.01);
        CHECK(touch(*mesh, ball, there));
        CHECK_FALSE(isFartherThan(0, *mesh, Isometry3d::Identity(), ball, there));
      }
    }
}

TEMPLATE_TEST_CASE("the boxes of a mesh that was built are used, however regular it is", "", fcl::OBBd,
                   fcl::RSSd, fcl::kIOSd, fcl::OBBRSSd) {
  checkFresh(*bumpyGround<TestType>(24, 0.0));
  checkFresh(*bumpyGround<TestType>(24, 0.05));
  for (const double length : {0.1, 1.0, 10.0}) {
    fcl::BVHModel<TestType> box, ball;
    fcl::generateBVHModel(box, fcl::Boxd(length, 0.3, 0.2), fcl::Transform3d::Identity());
    fcl::generateBVHModel(ball, fcl::Ellipsoidd(length, 0.3, 0.2), fcl::Transform3d::Identity(), 16, 16);
    checkFresh(box);
    checkFresh(ball);
  }
  for (const std::size_t squares : {2u, 5u, 64u, 200u}) {  // a strip along x
    Soup strip;
    for (std::size_t i = 0; i <= squares; ++i)
      for (const double y : {0.0, 1.0}) strip.points.emplace_back(static_cast<double>(i), y, 0);
    for (std::size_t i = 0; i < squares; ++i) {
      strip.triangles.emplace_back(2 * i, 2 * i + 2, 2 * i + 1);
      strip.triangles.emplace_back(2 * i + 2, 2 * i + 3, 2 * i + 1);
    }
    checkFresh(*meshOf<TestType>(strip.points, strip.triangles));
  }
}

TEMPLATE_TEST_CASE("boxes fitted to a moved mesh lead to the few triangles near a place", "", fcl::OBBd,
                   fcl::RSSd, fcl::kIOSd, fcl::OBBRSSd) {
  using detail::ElementTree;
  const auto mesh = bumpyGround<TestType>(48, 0.05);
  const Isometry3d by = pose(Random(3).rotation(), {0.3, 0.2, 0.1});
  std::vector<Vector3d> moved;
  for (int i = 0; i < mesh->num_vertices; ++i) moved.push_back(by * mesh->vertices[i]);
  mesh->beginReplaceModel();
  mesh->replaceSubModel(moved);
  mesh->endReplaceModel();
  const ElementTree tree(*mesh);
  REQUIRE(tree.merged());
  const Vector3d place = moved[moved.size() / 2];
  std::vector<ElementTree::Node> open{tree.root()};
  int looked = 0;
  std::vector<std::intptr_t> found;
  while (!open.empty()) {
    const ElementTree::Node node = open.back();
    open.pop_back();
    ++looked;
    if (((place - node.box.centre).cwiseAbs() - node.box.half).maxCoeff() > 0) continue;
    if (node.leaf) {
      found.push_back(node.id);
      continue;
    }
    std::array<ElementTree::Node, 8> child;
    const int children = tree.children(node, child);
    open.insert(open.end(), child.begin(), child.begin() + children);
  }
  CHECK(looked < mesh->num_tris / 10);
  for (int i = 0; i < mesh->num_tris; ++i)  // the six triangles around the corner are among them
    for (int k = 0; k < 3; ++k)
      if (mesh->tri_indices[i][k] == moved.size() / 2)
        CHECK(std::find(found.begin(), found.end(), i) != found.end());
}

TEMPLATE_TEST_CASE("a cloud that was begun with room for triangles is its points", "", fcl::AABBd, fcl::OBBd,
                   fcl::RSSd, fcl::kIOSd, fcl::OBBRSSd, (fcl::KDOP<double, 16>), (fcl::KDOP<double, 24>)) {
  constexpr bool goesByPoints =
      !std::is_same_v<TestType, fcl::OBBd> && !std::is_same_v<TestType, fcl::RSSd> &&
      !std::is_same_v<TestType, fcl::kIOSd> && !std::is_same_v<TestType, fcl::OBBRSSd>;
  Random random(13);
  const fcl::Sphered ball(0.1);
  const Isometry3d still = Isometry3d::Identity();
  for (const std::size_t count : {1u, 2u, 7u, 60u}) {
    std::vector<Vector3d> points;
    for (std::size_t i = 0; i < count; ++i) points.push_back(random.uniform(0, 1) * random.direction());
    fcl::BVHModel<TestType> cloud;
    // FCL fits rotated boxes to triangles that do not exist, with whatever is in the memory. So these clouds
    // get the array afterwards.
    cloud.beginModel(goesByPoints ? 8 : 0, static_cast<int>(count));
    for (const Vector3d& p : points) cloud.addVertex(p);
    cloud.endModel();
    if (!goesByPoints) cloud.tri_indices = new fcl::Triangle[0];
    REQUIRE(cloud.tri_indices);
    CHECK(detail::ElementTree(cloud).merged() == !goesByPoints);
    CHECK(hasFiniteCorners(cloud) == goesByPoints);
    for (int i = 0; i < 40; ++i) {
      const Vector3d at = random.uniform(0, 1.5) * random.direction();
      const Isometry3d there = pose(random.rotation(), at);
      std::size_t nearest = 0;
      for (std::size_t k = 1; k < count; ++k)
        if ((points[k] - at).norm() < (points[nearest] - at).norm()) nearest = k;
      const double least = (points[nearest] - at).norm() - 0.1;
      CAPTURE(count, i);
      const DistanceAnswer d = distance(cloud, still, ball, there);
      CHECK(std::abs(d.distance - least) <= 1e-15);
      CHECK(d.element[0] == static_cast<std::intptr_t>(nearest));
      CHECK(touch(cloud, ball, there) == (least <= 0));
      CHECK(isFartherThan(least - 1e-6, cloud, still, ball, there));
      CHECK_FALSE(isFartherThan(least + 1e-6, cloud, still, ball, there));
      DistanceHessian second;
      CHECK(hessian(cloud, still, ball, there, d, second));
    }
  }
}

#if FCL_HAVE_OCTOMAP
TEST_CASE("a cell far from its tree's origin is never called clear by its rounding") {
  Random random(5);
  const fcl::Sphered ball(0.5);
  const StpBvGeometry smooth(StpBv::build({{0, 0, 0}}, {0.5, 1}));
  for (const double far : {4.0, 400.0, 3000.0})
    for (int i = 0; i < 500; ++i) {
      const auto tree = std::make_shared<octomap::OcTree>(0.25);
      const Vector3d near = far * random.direction();
      const octomap::point3d cell = tree->keyToCoord(tree->coordToKey(octomap::point3d(
          static_cast<float>(near.x()), static_cast<float>(near.y()), static_cast<float>(near.z()))));
      tree->updateNode(cell, true);
      const fcl::OcTreed cells(tree);
      const Isometry3d at = pose(random.rotation(), random.direction());
      const Matrix3L rotation = nearestRotation(at.linear());  // the exact rotation that the pose stands for
      const Vector3L centre =
          rotation * Vector3L(cell.x(), cell.y(), cell.z()) + at.translation().cast<long double>();
      const Vector3L x = rotation.col(0);
      const double depth = std::pow(10.0, random.uniform(-15, -11));
      const Isometry3d there =
          pose(Eigen::Matrix3d::Identity(), (centre + (0.625L - depth) * x).cast<double>());
      const long double gap = x.dot(Vector3L(there.translation().cast<long double>() - centre)) - 0.625L;
      if (!(gap < 0)) continue;  // the point was rounded out of the cell
      CAPTURE(far, i);
      for (const fcl::CollisionGeometryd* other : {static_cast<const fcl::CollisionGeometryd*>(&ball),
                                                   static_cast<const fcl::CollisionGeometryd*>(&smooth)}) {
        CHECK_FALSE(isFartherThan(0, *other, there, cells, at));
        fcl::CollisionResultd result;
        CHECK(collide(other, there, &cells, at, fcl::CollisionRequestd(1), result) == 1);
        const DistanceAnswer d = distance(*other, there, cells, at);
        CHECK(d.lower <= gap);
        CHECK(d.upper >= gap);
      }
    }
}
#endif

TEST_CASE("an interpolated motion without a reference point goes as FCL's object does, or has no answer") {
  const fcl::Boxd box(0.4, 0.4, 0.4), wall(0.1, 20, 20);
  const Isometry3d begin = Isometry3d::Identity(), still = Isometry3d::Identity();
  const Eigen::Matrix3d half = Eigen::AngleAxisd(2, Vector3d::UnitZ()).toRotationMatrix();
  for (const bool turns : {true, false}) {
    const Isometry3d end = pose(turns ? half : Eigen::Matrix3d(Eigen::Matrix3d::Identity()), {4, 0, 0});
    for (const double held : {0.0, 1.0, 5.0, 1e7, std::numeric_limits<double>::quiet_NaN()}) {
      CAPTURE(turns, held);
      alignas(fcl::InterpMotion<double>)
          std::array<double, sizeof(fcl::InterpMotion<double>) / sizeof(double)>
              memory;
      memory.fill(held);
      auto* motion = new (memory.data()) fcl::InterpMotion<double>(begin, end);
      const Vector3d point = motion->getReferencePoint();
      SteadyMotion steady;
      const bool known = steadyMotion(*motion, steady);
      // The compiler's optimiser decides what is in uninitialised memory, so this tests the object as it is.
      CHECK(known == (!turns || point.lpNorm<1>() < 1e6));
      if (known && point.lpNorm<1>() < 1e6)
        for (const double t : {0.0, 0.3, 0.5, 1.0}) {
          Isometry3d there;
          motion->integrate(t);
          motion->getCurrentTransform(there);
          CHECK((steady.at(t).matrix() - there.matrix()).lpNorm<Eigen::Infinity>() <= 1e-13);
        }
      if (!known) {
        const fcl::TranslationMotion<double> stays(still, still);
        fcl::ContinuousCollisionResultd result;
        CHECK(continuousCollide(&box, motion, &wall, &stays, {}, result) == -1);
        CHECK(result.is_collide);
      }
      motion->~InterpMotion();
    }
  }
}
