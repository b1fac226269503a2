// Second derivatives through the drop-in against differences of its gradient: shapes, meshes, octrees.
#include <fcl/config.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/sphere.h>
#if FCL_HAVE_OCTOMAP
#include <fcl/geometry/octree/octree.h>
#endif

#include <catch2/catch.hpp>

#include "fcl_stpbv/adapter/fcl_hessian.h"
#include "test/adapter/element_kinds.h"
#include "test/reference/fcl_bodies.h"
#include "test/reference/reference.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

#if FCL_HAVE_OCTOMAP
Geometry cells() {
  auto tree = std::make_shared<octomap::OcTree>(0.1);
  Random random(5);
  for (int i = 0; i < 60; ++i)
    tree->updateNode(octomap::point3d(static_cast<float>(random.uniform(-0.5, 0.5)),
                                      static_cast<float>(random.uniform(-0.5, 0.5)),
                                      static_cast<float>(random.uniform(-0.5, 0.5))),
                     true);
  return std::make_shared<fcl::OcTreed>(tree);
}
#endif

struct Compared {
  double worst = 0;
  int poses = 0, boundaries = 0, none = 0;
};

// Compares the Hessian at one pose with differences of the gradient. Poses where the one-sided differences
// disagree, or where another element becomes nearest, are counted and left out.
void compare(const fcl::CollisionGeometryd& a, const Isometry3d& poseA, const fcl::CollisionGeometryd& b,
             const Isometry3d& poseB, Compared& all) {
  constexpr double kStep = 4e-6;
  const DistanceAnswer d = distance(a, poseA, b, poseB);
  DistanceHessian h;
  if (!hessian(a, poseA, b, poseB, d, h)) {
    ++all.none;
    return;
  }
  Eigen::Matrix<double, 12, 12> second;
  bool smooth = true;
  for (int k = 0; k < 12; ++k) {
    Eigen::Matrix<double, 12, 1> g[5];
    for (int s = 0; s < 5; ++s) {
      const double step = (s - 2) * kStep;
      const Isometry3d pa = k < 6 ? moved(poseA, k, step) : poseA,
                       pb = k < 6 ? poseB : moved(poseB, k - 6, step);
      const DistanceAnswer side = distance(a, pa, b, pb);
      g[s] << side.gradient[0], side.gradient[1];
      smooth = smooth && side.element == d.element;
    }
    second.col(k) = (8 * (g[3] - g[1]) - (g[4] - g[0])) / (12 * kStep);
    const auto ahead = (g[4] - g[2]) / (2 * kStep), behind = (g[2] - g[0]) / (2 * kStep);
    // Third derivatives times the step are a thousandth of this.
    smooth = smooth && (ahead - behind).norm() <= 1e-2 * (1 + second.col(k).norm());
  }
  if (!smooth) {
    ++all.boundaries;
    return;
  }
  const Eigen::Matrix<double, 12, 12> symmetric = 0.5 * (second + second.transpose());
  all.worst = std::max(all.worst,
                       (symmetric - h.matrix).cwiseAbs().maxCoeff() / (1 + h.matrix.cwiseAbs().maxCoeff()));
  ++all.poses;
}

}  // namespace

TEST_CASE("the Hessian through the drop-in is the change of its gradient, for shapes, triangles and cells") {
  const Geometry body = link(0.02, 2);
  std::vector<Geometry> others{std::make_shared<fcl::Sphered>(0.1),
                               std::make_shared<fcl::Capsuled>(0.1, 0.3),
                               std::make_shared<fcl::Ellipsoidd>(0.1, 0.2, 0.3),
                               std::make_shared<fcl::Boxd>(0.3, 0.2, 0.4),
                               std::make_shared<fcl::Cylinderd>(0.1, 0.3),
                               std::make_shared<fcl::Coned>(0.1, 0.3),
                               std::make_shared<fcl::Halfspaced>(Vector3d(0, 0, 1), 0.1),
                               link(0.02, 2),
                               bumpyGround<fcl::OBBRSSd>(8, 0.1)};
#if FCL_HAVE_OCTOMAP
  others.push_back(cells());
#endif
  for (const Geometry& other : others) {
    Random random(7);
    Compared all;
    for (int i = 0; i < 60; ++i) {
      const Isometry3d poseB = pose(random.rotation(), 0.5 * random.direction());
      Isometry3d poseA = poseB * pose(random.rotation(), random.uniform(0.5, 1.2) * random.direction());
      // Move to a gap of 5 cm, or to a very slight penetration.
      const double gap = i % 3 == 0 ? -0.01 : 0.05;
      for (int round = 0; round < 3; ++round) {
        const DistanceAnswer d = distance(*body, poseA, *other, poseB);
        poseA.translation() += (d.distance - gap) * d.normal;
      }
      compare(*body, poseA, *other, poseB, all);
      compare(*other, poseB, *body, poseA, all);
    }
    INFO("type " << other->getNodeType() << ": " << all.poses << " compared, " << all.boundaries
                 << " on a boundary, " << all.none << " without");
    // The gradient's rounding (about 1e-15) divided by the step, and the step to the fourth power.
    CHECK(all.worst < 1e-7);
    CHECK(all.poses >= 40);
  }
}

#if FCL_HAVE_OCTOMAP
TEST_CASE("a tree's cell has its Hessian however far from the world's origin the pair is") {
  const Geometry body = link(0.02, 2), tree = cells();
  Random random(9);
  for (const double far : {0.0, 1e5, 1e6, 1e7})
    for (int i = 0; i < 100; ++i) {
      const Isometry3d poseB = pose(random.rotation(), far * random.direction());
      Isometry3d poseA = poseB * pose(random.rotation(), 1.2 * random.direction());
      const DistanceAnswer d = distance(*body, poseA, *tree, poseB);
      DistanceHessian h;
      CAPTURE(far, i);
      REQUIRE(d.status == DistanceStatus::exact);
      CHECK(hessian(*body, poseA, *tree, poseB, d, h));
    }
}
#endif

TEST_CASE("without an STP-BV the Hessian is the change of the gradient, too: shapes, triangles, cells") {
  std::vector<Geometry> bodies{std::make_shared<fcl::Boxd>(0.3, 0.2, 0.4),
                               std::make_shared<fcl::Ellipsoidd>(0.1, 0.2, 0.3),
                               std::make_shared<fcl::Coned>(0.1, 0.3), bumpyGround<fcl::OBBRSSd>(4, 0.1)};
#if FCL_HAVE_OCTOMAP
  bodies.push_back(cells());
#endif
  Random random(8);
  Compared all;
  for (const Geometry& first : bodies)
    for (const Geometry& second : bodies)
      for (int i = 0; i < 12; ++i) {
        const Isometry3d poseA = pose(random.rotation(), 0.5 * random.direction()),
                         poseB = pose(random.rotation(), poseA.translation() + 1.5 * random.direction());
        if (distance(*first, poseA, *second, poseB).distance > 0.05)
          compare(*first, poseA, *second, poseB, all);
      }
  CHECK(all.worst < 1e-7);
  CHECK(all.poses >= 200);
  CHECK(all.none == 0);
}

TEST_CASE("there is no Hessian of parallel faces, of meshes that overlap, of no answer, and of no element") {
  const Geometry body = link(0.02, 2), ground = bumpyGround<fcl::OBBRSSd>(8, 0.1),
                 ball = std::make_shared<fcl::Sphered>(0.1),
                 crate = std::make_shared<fcl::Boxd>(0.1, 0.1, 0.1);
  const Isometry3d at = Isometry3d::Identity(), above = pose(Eigen::Matrix3d::Identity(), {0, 0, 1});
  DistanceHessian h;
  CHECK_FALSE(hessian(*crate, at, *crate, above, distance(*crate, at, *crate, above), h));
  CHECK_FALSE(hessian(*ground, at, *ground, at, distance(*ground, at, *ground, at), h));
  CHECK_FALSE(hessian(*body, at, *ball, above, DistanceAnswer{}, h));
  DistanceAnswer d = distance(*body, above, *ground, at);
  CHECK(hessian(*body, above, *ground, at, d, h));
  d.element[1] = 100000;
  CHECK_FALSE(hessian(*body, above, *ground, at, d, h));
  d.element[1] = -1;
  CHECK_FALSE(hessian(*body, above, *ground, at, d, h));
}

TEST_CASE("the Hessian and rates of two objects are those of their geometries at their poses") {
  const auto body = std::make_shared<StpBvGeometry>(StpBv::build(box(0.2, 0.3, 0.4)));
  const fcl::CollisionObjectd one(body, pose(Eigen::Matrix3d::Identity(), {0, 0, 0})),
      two(std::make_shared<fcl::Boxd>(0.1, 0.2, 0.3), pose(Random(3).rotation(), {0, 0.1, 1}));
  const DistanceAnswer d = distance(one, two);
  DistanceHessian h, same;
  REQUIRE(hessian(one, two, d, h));
  REQUIRE(hessian(*one.collisionGeometry(), one.getTransform(), *two.collisionGeometry(), two.getTransform(),
                  d, same));
  CHECK(h.matrix == same.matrix);

  BodyTwists twists;
  twists << 0.1, -0.2, 0.3, 0.4, 0.5, -0.6, -0.3, 0.2, 0.1, 0.6, -0.5, 0.4;
  DistanceRate moving, still;
  REQUIRE(rate(one, two, d, twists, moving));
  REQUIRE(rate(*one.collisionGeometry(), one.getTransform(), *two.collisionGeometry(), two.getTransform(), d,
               twists, still));
  CHECK(moving.normal == still.normal);
  CHECK_FALSE(moving.normal.isZero());
}

TEST_CASE(
    "at a pose whose rotation went through single precision the Hessian is that at the nearest rotation") {
  std::vector<ElementKind> kinds = elementKinds();
  kinds.push_back({"cylinder", std::make_shared<fcl::Cylinderd>(0.1, 0.4), {}, false});
  kinds.push_back({"volume", geometryOf(box(0.3, 0.2, 0.1), 0.01, 10), {}, false});
  Random random(7);
  int known = 0;
  for (const ElementKind& first : kinds)
    for (const ElementKind& second : kinds)
      for (int i = 0; i < 4; ++i) {
        CAPTURE(first.name, second.name, i);
        const auto coarse = [&](const Vector3d& place) {
          return pose(random.rotation().cast<float>().cast<double>(), place);
        };
        const auto nearest = [](const Isometry3d& p) {
          return pose(nearestRotation(p.linear()).cast<double>(), p.translation());
        };
        const Isometry3d a = coarse({0, 0, 0}), b = coarse(random.direction()), c = nearest(a),
                         e = nearest(b);
        const DistanceAnswer d = distance(*first.geometry, a, *second.geometry, b),
                             there = distance(*first.geometry, c, *second.geometry, e);
        DistanceHessian h, truth;
        const bool exists = hessian(*first.geometry, c, *second.geometry, e, there, truth);
        CHECK(hessian(*first.geometry, a, *second.geometry, b, d, h) == exists);
        if (!exists) continue;
        ++known;
        CHECK((h.matrix - truth.matrix).norm() <= 1e-9 * (1 + truth.matrix.norm()));
        CHECK((h.normal - truth.normal).norm() <= 1e-9 * (1 + truth.normal.norm()));
        for (std::size_t k = 0; k < 2; ++k)
          CHECK((h.point[k] - truth.point[k]).norm() <= 1e-9 * (1 + truth.point[k].norm()));
      }
  CHECK(known > 300);
}
