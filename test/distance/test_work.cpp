// Counts the work of a query, so that a slower solver fails here whatever else the machine does.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "fcl_stpbv/distance/distance.h"
#include "test/reference/allocations.h"
#include "test/reference/motion.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using fcl_stpbv::benchmark::GeodesicMotion;
using fcl_stpbv::benchmark::Poses;
using fcl_stpbv::benchmark::Step;

namespace {

/// Means over the queries whose bodies overlap by at most their margins, and the largest value of a query.
struct Work {
  double pairs = 0, steps = 0;
  int mostPairs = 0, mostSteps = 0;
  int queries = 0, deeper = 0, notSolved = 0;
  long allocated = 0;
};

Work workOf(const Cloud& cloud, const Step& step, bool warm) {
  const StpBv::Ptr a = StpBv::build(cloud, {0.01, 10}), b = StpBv::build(cloud, {0.01, 10});
  GeodesicMotion motion(step, 1);
  Poses poses;
  motion.next(poses, 4 * GeodesicMotion::kCycle);
  PairCache cache;
  Work work;
  const long before = allocations;
  for (std::size_t i = 0; i < poses.a.size(); ++i) {
    const Distance d = distance(*a, poses.a[i], *b, poses.b[i], warm ? &cache : nullptr);
    work.notSolved += d.status == DistanceStatus::bounded || d.status == DistanceStatus::invalid;
    if (d.status != DistanceStatus::exact) {
      ++work.deeper;
      continue;
    }
    ++work.queries;
    work.pairs += d.patchPairs;
    work.steps += d.patchSteps;
    work.mostPairs = std::max(work.mostPairs, d.patchPairs);
    work.mostSteps = std::max(work.mostSteps, d.patchSteps);
  }
  work.allocated = allocations - before;
  work.pairs /= work.queries;
  work.steps /= work.queries;
  return work;
}

/// Limits for a workload: the values measured when this was written, plus a tenth.
struct Bound {
  int subdivisions;
  bool large, warm;
  double pairs, steps;
  int mostPairs, mostSteps;
};

}  // namespace

TEST_CASE("A query on turning geodesic spheres takes no more work than it did, and no allocation") {
  const Bound bounds[] = {
      {0, false, true, 1.24, 0.14, 6, 5},   {0, true, true, 2.85, 1.76, 14, 15},
      {0, true, false, 2.70, 1.61, 14, 15}, {2, false, true, 1.70, 0.61, 14, 16},
      {2, true, true, 3.08, 2.04, 14, 15},  {2, true, false, 2.97, 1.89, 14, 15},
      {4, false, true, 3.58, 2.50, 14, 15}, {4, true, true, 3.14, 2.10, 14, 15},
      {4, true, false, 3.09, 2.01, 14, 15},
  };
  for (const Bound& bound : bounds) {
    const Work work = workOf(geodesicSphere(0.2, bound.subdivisions),
                             bound.large ? benchmark::largeStep() : benchmark::smallStep(), bound.warm);
    INFO("subdivisions " << bound.subdivisions << (bound.large ? ", large" : ", small") << " steps, "
                         << (bound.warm ? "warm" : "cold") << ": pairs " << work.pairs << " most "
                         << work.mostPairs << ", steps " << work.steps << " most " << work.mostSteps);
    CHECK(work.pairs <= bound.pairs);
    CHECK(work.steps <= bound.steps);
    CHECK(work.mostPairs <= bound.mostPairs);
    CHECK(work.mostSteps <= bound.mostSteps);
    CHECK(work.allocated == 0);
    CHECK(work.notSolved == 0);
    CHECK(work.queries > 20 * work.deeper);  // most queries of the motion are those that the bounds are about
  }
}
