// Answers to a fixed set of queries, to compare builds: answers COUNT writes a row of distance, normal and
// witness points for each.
#include <cstdio>
#include <cstdlib>

#include "fcl_stpbv/distance/distance.h"
#include "test/reference/arguments.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

int main(int argc, char** argv) {
  const int count = Arguments(argc, argv, "[COUNT]", 1).number(1, 1000);
  std::vector<StpBv::Ptr> bodies;
  for (const Cloud& cloud : {box(0.3, 0.2, 0.1), plate(0.4, 0.3), needle(0.5), cylinder(0.1, 0.3),
                             geodesicSphere(0.2, 2), randomHull(60, {0.2, 0.1, 0.15}, 7)})
    bodies.push_back(StpBv::build(cloud, {0.01, 10.0}));
  Random random(5);
  for (int i = 0; i < count; ++i) {
    const StpBv &a = *bodies[static_cast<std::size_t>(random.below(6))],
                &b = *bodies[static_cast<std::size_t>(random.below(6))];
    // Apart, touching and overlapping bodies; then a small step further, with the cache of the first answer.
    // Numbers are drawn in separate statements, because compilers evaluate the arguments of a call in
    // different orders.
    const Eigen::Matrix3d turnA = random.rotation(), turnB = random.rotation();
    const Eigen::Vector3d at = random.direction(), towards = random.direction();
    const Eigen::Isometry3d poseA = pose(turnA, at),
                            poseB = pose(turnB, at + random.uniform(0.02, 0.8) * towards);
    PairCache cache;
    for (const double step : {0.0, 0.02}) {
      const Eigen::Isometry3d there = pose(poseB.linear() * random.rotation(step), poseB.translation());
      const Distance d = distance(a, poseA, b, there, &cache);
      std::printf("%d %.17g", static_cast<int>(d.status), d.distance);
      for (const Eigen::Vector3d& v : {d.normal, d.point[0], d.point[1]})
        std::printf(" %.17g %.17g %.17g", v.x(), v.y(), v.z());
      std::printf("\n");
    }
  }
  return 0;
}
