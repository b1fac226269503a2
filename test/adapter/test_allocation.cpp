// Queries on STP-BVs do not allocate: this program counts every operator new.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/geometric_shape_to_BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/math/bv/utility.h>

#include <catch2/catch.hpp>
#include <limits>
#include <vector>

#include "fcl_stpbv/adapter/continuous_collide.h"
#include "fcl_stpbv/adapter/element_tree.h"
#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/polyhedral_witness.h"
#include "test/reference/allocations.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;

TEST_CASE("no query on STP-BVs allocates, cold or warm, separated, deep or invalid") {
  const auto a = std::make_shared<StpBvGeometry>(StpBv::build(geodesicSphere(0.2, 3)));
  const auto b = std::make_shared<StpBvGeometry>(StpBv::build(box(0.2, 0.3, 0.4)));
  fcl::CollisionObjectd first(a), second(b);
  Random random(1);
  PairDistance pair(a, b);
  PairCaches caches;
  caches.of(&first, &second);  // this is a pair's only allocation
  fcl::DistanceRequestd request;
  fcl::DistanceResultd result;
  const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();

  const long before = allocations;
  for (int i = 0; i < 2000; ++i) {
    Eigen::Isometry3d there = pose(random.rotation(), random.uniform(0, 0.9) * random.direction());
    if (i % 100 == 0) there.translation()[0] = std::numeric_limits<double>::quiet_NaN();
    polyhedralWitness(a->hull(), here, b->hull(), there);
    pair(here, there);
    distance(a.get(), here, b.get(), there, request, result);
    second.setTransform(there);
    DistanceData data;
    data.caches = &caches;
    double dist = 1e300;
    distanceCallback(&first, &second, &data, dist);
  }
  CHECK(allocations == before);
}

TEST_CASE("no query of an STP-BV against another geometry allocates") {
  const StpBvGeometry a(StpBv::build(geodesicSphere(0.2, 2))), b(StpBv::build(box(0.2, 0.3, 0.4)));
  const fcl::Convexd& hull = b;
  const fcl::Convexd plain(std::make_shared<const std::vector<fcl::Vector3d>>(hull.getVertices()),
                           hull.getFaceCount(), std::make_shared<const std::vector<int>>(hull.getFaces()));
  const fcl::Boxd crate(0.2, 0.3, 0.4);
  const fcl::Cylinderd post(0.1, 0.4);
  const fcl::Coned cone(0.1, 0.4);
  fcl::BVHModel<fcl::OBBRSSd> mesh;
  fcl::generateBVHModel(mesh, crate, Eigen::Isometry3d::Identity());
  Random random(2);
  long seen = 0;
  const long before = allocations;
  for (int i = 0; i < 1000; ++i)
    for (const fcl::CollisionGeometryd* other : {static_cast<const fcl::CollisionGeometryd*>(&plain),
                                                 static_cast<const fcl::CollisionGeometryd*>(&crate),
                                                 static_cast<const fcl::CollisionGeometryd*>(&post),
                                                 static_cast<const fcl::CollisionGeometryd*>(&cone),
                                                 static_cast<const fcl::CollisionGeometryd*>(&mesh)}) {
      const Eigen::Isometry3d there = pose(random.rotation(), random.uniform(0, 0.9) * random.direction());
      seen += distance(a, Eigen::Isometry3d::Identity(), *other, there).status != DistanceStatus::invalid;
    }
  CHECK(allocations == before);
  CHECK(seen == 5000);
}

TEST_CASE(
    "a motion fits boxes that replace merged ones only once, and the question whether there are any fits "
    "none") {
  fcl::BVHModel<fcl::OBBRSSd> mesh;
  fcl::generateBVHModel(mesh, fcl::Cylinderd(0.1, 0.4), Eigen::Isometry3d::Identity(), 12, 12);
  const std::vector<Eigen::Vector3d> corners(mesh.vertices, mesh.vertices + mesh.num_vertices);
  mesh.beginReplaceModel();
  mesh.replaceSubModel(corners);
  mesh.endReplaceModel();
  REQUIRE(ElementTree(mesh).merged());
  const long before = allocations;
  CHECK_FALSE(hasFiniteCorners(mesh));
  CHECK(allocations == before);

  const StpBvGeometry ball(StpBv::build(geodesicSphere(0.2, 2)));
  SteadyMotion still, past;
  past.begin.translation() = Eigen::Vector3d(1, 0.1, 0.05);
  past.linear = {-2, 0, 0};
  past.angular = {0, 0, 2};
  const auto taken = [&](const fcl::CollisionGeometryd& other, double tolerance, long* queries) {
    const long start = allocations;
    *queries = firstContact(mesh, still, other, past, {0, tolerance}).queries;
    return allocations - start;
  };
  for (const fcl::CollisionGeometryd* other : {static_cast<const fcl::CollisionGeometryd*>(&ball),
                                               static_cast<const fcl::CollisionGeometryd*>(&mesh)}) {
    long few = 0, many = 0;
    const long coarse = taken(*other, 0.1, &few), fine = taken(*other, 1e-10, &many);
    CHECK(many > few + 10);
    CHECK(fine <= coarse + 6);  // allocations of the search's own lists
  }
}
