// No query allocates: this program counts every operator new.
#include <catch2/catch.hpp>
#include <limits>

#include "fcl_stpbv/distance/distance.h"
#include "test/reference/allocations.h"
#include "test/reference/shapes.h"

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
