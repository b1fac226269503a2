// Queries on STP-BVs do not allocate: this program counts every operator new.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/geometric_shape_to_BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>

#include <catch2/catch.hpp>
#include <limits>

#include "fcl_stpbv/adapter/distance_callback.h"
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
  caches.of(&first, &second);  // the one allocation of a pair
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
