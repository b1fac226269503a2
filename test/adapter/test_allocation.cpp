// Queries on STP-BVs do not allocate: this program counts every operator new.
#include <atomic>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <limits>
#include <new>

#include "fcl_stpbv/adapter/distance_callback.h"
#include "fcl_stpbv/adapter/pair_distance.h"
#include "test/shapes.h"

static std::atomic<long> allocations{0};

void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

using namespace fcl_stpbv;
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
