// Warm queries on turning geodesic spheres, for a tool that counts instructions:
// geodesic_queries QUERIES small|large.
#include <cstdio>

#include "fcl_stpbv/distance/distance.h"
#include "test/reference/arguments.h"
#include "test/reference/motion.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;

int main(int argc, char** argv) {
  const test::Arguments arguments(argc, argv, "[QUERIES [small|large]]", 2);
  const int queries = arguments.number(1, 1000, 0);
  const bool large = arguments.oneOf(2, {"small", "large"}) == "large";
  const StpBv::Ptr a = StpBv::build(test::geodesicSphere(0.2, 2), {0.01, 10}),
                   b = StpBv::build(test::geodesicSphere(0.2, 2), {0.01, 10});
  benchmark::GeodesicMotion motion(large ? benchmark::largeStep() : benchmark::smallStep(), 1);
  benchmark::Poses poses;
  motion.next(poses, benchmark::GeodesicMotion::kCycle);  // the same poses made, however few are asked
  PairCache cache;
  double sum = 0;
  for (std::size_t i = 0; i < poses.a.size() && i < static_cast<std::size_t>(queries); ++i)
    sum += distance(*a, poses.a[i], *b, poses.b[i], &cache).distance;
  std::printf("%.17g\n", sum);
  return 0;
}
