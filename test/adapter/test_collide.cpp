// Contacts in FCL's terms, of smooth bodies, shapes, meshes and trees.
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree_array.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <tuple>

#include "fcl_stpbv/adapter/collide.h"
#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "test/adapter/element_kinds.h"
#include "test/reference/reference.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

std::vector<fcl::Contactd> contactsOf(const fcl::CollisionGeometryd& a, const Isometry3d& poseA,
                                      const fcl::CollisionGeometryd& b, const Isometry3d& poseB,
                                      std::size_t most = 100000, bool detail = true) {
  fcl::CollisionRequestd request(most, detail);
  fcl::CollisionResultd result;
  const std::size_t count = fcl_stpbv::collide(&a, poseA, &b, poseB, request, result);
  REQUIRE(count == result.numContacts());
  std::vector<fcl::Contactd> all;
  result.getContacts(all);
  return all;
}

}  // namespace

TEST_CASE(
    "two smooth bodies have one contact with the depth, normal and place of the truth, in either order") {
  Random random(1);
  const Cloud p = randomHull(30, {0.2, 0.15, 0.1}, 3), q = box(0.2, 0.3, 0.4);
  const StpBvGeometry a(StpBv::build(p, {0.03, 10})), b(StpBv::build(q, {0.02, 10}));
  int touching = 0, apart = 0;
  for (int i = 0; i < 400; ++i) {
    const Isometry3d pa = pose(random.rotation(), random.direction());
    Isometry3d pb = pose(random.rotation(), pa.translation() + 0.7 * random.direction());
    // Move to a distance that the margins allow, so that the reference's cores stay apart.
    const DistanceAnswer far = distance(a, pa, b, pb);
    pb.translation() -= (far.distance + random.uniform(-0.02, 0.04)) * far.normal;
    const ReferenceDistance truth = referenceDistance(
        referenceBody(p, 0.03, 10, pa), referenceBody(q, 0.02, 10, pb), far.normal.cast<long double>());
    const std::vector<fcl::Contactd> found = contactsOf(a, pa, b, pb);
    CAPTURE(i, static_cast<double>(truth.distance));
    CHECK(contactsOf(a, pa, b, pb, 1, false).size() == found.size());
    REQUIRE(found.size() == (truth.distance <= 0 ? 1 : 0));
    if (found.empty()) {
      ++apart;
      continue;
    }
    ++touching;
    CHECK(std::abs(found[0].penetration_depth + static_cast<double>(truth.distance)) <= 2e-15);
    // The error of a normal is the square root of the reference's gap of distances.
    CHECK((found[0].normal - truth.normal.cast<double>()).norm() <= 1e-7);
    CHECK((found[0].pos - (0.5 * (truth.point[0] + truth.point[1])).cast<double>()).norm() <= 1e-7);
    CHECK((found[0].o1 == &a && found[0].o2 == &b && found[0].b1 == -1 && found[0].b2 == -1));
    const std::vector<fcl::Contactd> other = contactsOf(b, pb, a, pa);
    REQUIRE(other.size() == 1);
    CHECK((other[0].normal + found[0].normal).norm() <= 1e-7);
    CHECK(other[0].o1 == &b);
  }
  CHECK((touching > 100 && apart > 50));
}

TEST_CASE("cubes whose margins alone overlap collide, where fcl::collide sees only their hulls") {
  const StpBvGeometry cube(StpBv::build(box(0.2, 0.2, 0.2), {0.05, 10}));
  const Isometry3d here = Isometry3d::Identity(), there = pose(Eigen::Matrix3d::Identity(), {0.25, 0, 0});
  const std::vector<fcl::Contactd> found = contactsOf(cube, here, cube, there);
  REQUIRE(found.size() == 1);
  CHECK(found[0].penetration_depth > 0.05);
  CHECK((found[0].normal - Vector3d::UnitX()).norm() <= 1e-12);
  CHECK((found[0].pos - Vector3d(0.125, 0, 0)).norm() <= 1e-12);
}

TEST_CASE("a call that names its scalar, as generic code does, is the same call") {
  const auto ball = std::make_shared<fcl::Sphered>(0.1);
  const fcl::CollisionObjectd a(ball), b(ball, pose(Eigen::Matrix3d::Identity(), {0.15, 0, 0}));
  fcl::CollisionResultd result;
  CHECK(fcl_stpbv::collide<double>(&a, &b, fcl::CollisionRequestd(1, true), result) == 1);
  REQUIRE(result.numContacts() == 1);
  CHECK(std::abs(result.getContact(0).penetration_depth - 0.05) <= 1e-15);
  fcl::DistanceResultd distant;
  CHECK(std::abs(fcl_stpbv::distance<double>(&a, &b, fcl::DistanceRequestd(), distant) + 0.05) <= 1e-15);
  CHECK(distant.o1 == ball.get());
  PairCache cache;
  QueryContext context;
  context.cache = &cache;
  const DistanceAnswer answer = fcl_stpbv::distance<double>(a, b, context);
  CHECK(answer.status == DistanceStatus::exact);
  CHECK(std::abs(answer.distance + 0.05) <= 1e-15);
}

TEST_CASE("meshes and trees have one contact for each two elements that meet, in either order") {
  const auto kinds = elementKinds();
  Random random(2);
  long met = 0;
  for (const ElementKind& first : kinds)
    for (const ElementKind& second : kinds) {
      if (!first.surface && !second.surface) continue;
      // Cells and boxes are solid, which the triangles of their sides do not show.
      if (first.name == "octree" || second.name == "octree" || first.name == "box" || second.name == "box")
        continue;
      CAPTURE(first.name, second.name);
      const Isometry3d a = pose(random.rotation(), random.direction());
      const Isometry3d b =
          pose(random.rotation(), a.translation() + random.uniform(0, 0.4) * random.direction());
      std::map<std::array<std::intptr_t, 2>, int> truth;
      for (const auto& [i, s] : first.triangles(a))
        for (const auto& [j, t] : second.triangles(b))
          if (referenceDistance(s[0], t[0]) == 0) truth[{i, j}] = 1;
      for (const fcl::Contactd& c : contactsOf(*first.geometry, a, *second.geometry, b)) {
        CHECK(truth[{c.b1, c.b2}]-- == 1);
        CHECK((c.o1 == first.geometry.get() && c.o2 == second.geometry.get()));
        CHECK(c.penetration_depth >= 0);
        ++met;
      }
      for (const auto& [pair, open] : truth) {
        CAPTURE(pair[0], pair[1]);
        CHECK(open == 0);
      }
      CHECK(contactsOf(*second.geometry, b, *first.geometry, a, 100000, false).size() == truth.size());
      if (truth.size() > 3) CHECK(contactsOf(*first.geometry, a, *second.geometry, b, 3).size() == 3);
    }
  CHECK(met > 300);
}

TEST_CASE("a box on a half space, a smooth body in a tree, touching and what has no answer") {
  const fcl::Boxd crate(0.2, 0.2, 0.2);
  const fcl::Halfspaced ground(Vector3d::UnitZ(), 0.0);
  const auto at = [](double z) { return pose(Eigen::Matrix3d::Identity(), {0, 0, z}); };
  const std::vector<fcl::Contactd> found = contactsOf(ground, at(0), crate, at(0.09));
  REQUIRE(found.size() == 1);
  CHECK(std::abs(found[0].penetration_depth - 0.01) <= 1e-15);
  CHECK((found[0].normal - Vector3d::UnitZ()).norm() <= 1e-15);
  CHECK(contactsOf(ground, at(0), crate, at(0.125)).empty());
  const fcl::Sphered ball(0.125);
  CHECK(contactsOf(ball, at(0), ball, at(0.25), 1, false).size() == 1);  // they touch
  CHECK(contactsOf(ball, at(0), ball, at(0.25), 1, true).size() == 1);
  for (const fcl::CollisionGeometryd* bad : {static_cast<const fcl::CollisionGeometryd*>(&ground)}) {
    const std::vector<fcl::Contactd> unknown = contactsOf(*bad, at(0), ground, at(1));
    REQUIRE(unknown.size() == 1);
    CHECK(std::isinf(unknown[0].penetration_depth));
    CHECK(unknown[0].normal == Vector3d(0, 0, 0));
  }
  CHECK(contactsOf(ball, at(std::nan("")), ball, at(1), 1, false).size() == 1);
  CHECK(contactsOf(ball, at(0), ball, at(0), 0).empty());
}

TEST_CASE("cells that FCL's marks call free or unknown collide with nothing") {
  const auto ball = std::make_shared<fcl::Sphered>(0.1), mark = std::make_shared<fcl::Sphered>(0.1);
  const auto body = std::make_shared<StpBvGeometry>(StpBv::build(box(0.2, 0.2, 0.2)));
  const auto mesh = meshKind<fcl::OBBRSSd>("OBBRSS").geometry;
  const Isometry3d here = Isometry3d::Identity(), there = pose(Eigen::Matrix3d::Identity(), {0.15, 0, 0});
  const auto count = [&](const fcl::CollisionGeometryd& other) {
    const std::size_t found = contactsOf(*mark, here, other, there).size();
    CHECK((contactsOf(other, there, *mark, here, 100000, false).size() > 0) == (found > 0));
    return found;
  };
  for (const auto& [density, threshold, meets] :
       {std::tuple(1.0, 1.0, true), {0.7, 0.7, true}, {0.5, 0.7, false}, {0.0, 1.0, false}}) {
    CAPTURE(density, threshold);
    mark->cost_density = density;
    mark->threshold_occupied = threshold;
    CHECK((count(*ball) > 0) == meets);
    CHECK((count(*body) > 0) == meets);
    CHECK((count(*mesh) > 0) == meets);
    fcl::CollisionResultd fcls;
    CHECK((fcl::collide(mark.get(), here, ball.get(), there, fcl::CollisionRequestd(), fcls) > 0) == meets);
  }
}

#if FCL_HAVE_OCTOMAP
TEMPLATE_TEST_CASE("a manager that hands over an octree's cells one by one meets the occupied ones alone", "",
                   fcl::DynamicAABBTreeCollisionManagerd, fcl::DynamicAABBTreeCollisionManager_Arrayd) {
  const auto cells = std::make_shared<octomap::OcTree>(0.1);
  cells->updateNode(octomap::point3d(0.05f, 0.05f, 0.05f), true);
  cells->updateNode(octomap::point3d(1.05f, 0.05f, 0.05f), false);
  fcl::CollisionObjectd tree(std::make_shared<fcl::OcTreed>(cells));
  for (const double x :
       {0.15, 1.05, 5.0}) {  // in the occupied cell, in the free one, where nobody has looked
    fcl::CollisionObjectd object(std::make_shared<StpBvGeometry>(StpBv::build({{0, 0, 0}}, {0.1, 1})),
                                 pose(Eigen::Matrix3d::Identity(), {x, 0.05, 0.05}));
    for (const bool whole : {true, false}) {
      CAPTURE(x, whole);
      TestType manager;
      manager.octree_as_geometry_collide = whole;
      manager.registerObject(&object);
      manager.setup();
      CollisionData data;
      data.request = fcl::CollisionRequestd(100, true);
      manager.collide(&tree, &data, collisionCallback);
      CHECK(data.result.numContacts() == (x < 1 ? 1 : 0));
    }
  }
}
#endif

TEST_CASE("the callback gathers a scene's contacts over pairs and stops at as many as were asked for") {
  Random random(4);
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects;
  const auto body = std::make_shared<StpBvGeometry>(StpBv::build(randomHull(20, {0.1, 0.1, 0.1}, 2)));
  for (int i = 0; i < 60; ++i) {
    objects.push_back(std::make_unique<fcl::CollisionObjectd>(
        body, pose(random.rotation(),
                   0.5 * Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)))));
    objects.back()->computeAABB();
  }
  fcl::DynamicAABBTreeCollisionManagerd manager;
  for (const auto& object : objects) manager.registerObject(object.get());
  manager.setup();
  std::size_t truth = 0;
  for (std::size_t i = 0; i < objects.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) truth += distance(*objects[i], *objects[j]).distance <= 0;
  REQUIRE(truth > 20);
  PairCaches caches;
  for (int round = 0; round < 2; ++round)
    for (const bool detail : {false, true}) {
      CollisionData data;
      data.request = fcl::CollisionRequestd(100000, detail);
      data.caches = &caches;
      manager.collide(&data, collisionCallback);
      CHECK(data.result.numContacts() == truth);
      CHECK_FALSE(data.done);
      CollisionData few;
      few.request = fcl::CollisionRequestd(7, detail);
      manager.collide(&few, collisionCallback);
      CHECK(few.result.numContacts() == 7);
      CHECK(few.done);
    }
}
