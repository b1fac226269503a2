// Warm queries on turning geodesic spheres, for a tool that counts instructions:
// geodesic_queries QUERIES small|large|deep
// `deep`: after small steps, only bodies that overlap by more than their margins.
#include <cstdio>
#include <string>

#include "fcl_stpbv/distance/distance.h"
#include "test/reference/arguments.h"
#include "test/reference/motion.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;

int main(int argc, char** argv) {
  const test::Arguments arguments(argc, argv, "[QUERIES [small|large|deep]]", 2);
  const int queries = arguments.number(1, 1000, 0);
  const std::string steps = arguments.oneOf(2, {"small", "large", "deep"});
  const StpBv::Ptr a = StpBv::build(test::geodesicSphere(0.2, 2), {0.01, 10}),
                   b = StpBv::build(test::geodesicSphere(0.2, 2), {0.01, 10});
  const bool deep = steps == "deep";
  benchmark::GeodesicMotion motion(steps == "large" ? benchmark::largeStep() : benchmark::smallStep(), 1,
                                   deep ? 0.3 : benchmark::GeodesicMotion::kNearest);
  benchmark::Poses poses;  // the same poses are made for any number of queries
  motion.next(poses, (deep ? 12 : 1) * benchmark::GeodesicMotion::kCycle);
  PairCache cache;
  double sum = 0;
  int asked = 0;
  for (std::size_t i = 0; i < poses.a.size() && asked < queries; ++i) {
    constexpr double kDeep = 0.36;  // m between the centres
    if (deep && (poses.b[i].translation() - poses.a[i].translation()).norm() > kDeep) continue;
    ++asked;
    sum += distance(*a, poses.a[i], *b, poses.b[i], &cache).distance;
  }
  std::printf("%.17g\n", sum);
  return 0;
}
