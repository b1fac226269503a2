// No query allocates: this program counts every operator new.
#include <atomic>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <limits>
#include <new>

#include "fcl_stpbv/distance/distance.h"
#include "test/reference/shapes.h"

static std::atomic<long> allocations{0};

void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {  // as std::stable_sort asks
  ++allocations;
  return std::malloc(size);
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

TEST_CASE("No query allocates, be it separated, penetrating, deep or invalid") {
  const StpBv::Ptr a = StpBv::build(box(0.3, 0.2, 0.5), {0.01, 10}),
                   b = StpBv::build(geodesicSphere(0.2, 2), {0.0, 10});
  Random random(1);
  PairCache cache;
  int seen[4] = {0, 0, 0, 0};
  const long before = allocations;
  for (int i = 0; i < 2000; ++i) {
    const Isometry3d pb = pose(random.rotation(), random.uniform(0.0, 0.6) * random.direction());
    ++seen[static_cast<int>(distance(*a, Isometry3d::Identity(), *b, pb, i % 2 ? &cache : nullptr).status)];
  }
  const Isometry3d bad = pose(random.rotation(), Vector3d(std::numeric_limits<double>::quiet_NaN(), 0, 0));
  ++seen[static_cast<int>(distance(*a, bad, *b, bad, nullptr).status)];
  CHECK(allocations == before);
  CHECK(seen[static_cast<int>(DistanceStatus::exact)] > 0);
  CHECK(seen[static_cast<int>(DistanceStatus::local)] > 0);
  CHECK(seen[static_cast<int>(DistanceStatus::invalid)] == 1);
  CHECK(seen[static_cast<int>(DistanceStatus::bounded)] == 0);
}
