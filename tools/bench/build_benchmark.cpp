// Time and memory of building volumes against the number of points: the table of docs/volume.md.
//   build_benchmark
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <vector>

#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/stp_bv.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

namespace {

void row(const char* name, const Cloud& points, double R = 10) {
  std::vector<double> seconds;
  StpBv::Ptr volume;
  for (int run = 0; run < 5; ++run) {
    const auto begin = std::chrono::steady_clock::now();
    volume = StpBv::build(points, {0.01, R});
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  std::sort(seconds.begin(), seconds.end());
  const double vertices = volume->vertexCount(), median = seconds[2];
  std::printf("| %s | %zu | %.0f | %.3f | %.2f | %.0f |\n", name, points.size(), vertices, median,
              1e6 * median / (vertices * std::log2(vertices + 1)),
              static_cast<double>(volume->memory()) / vertices);
  std::fflush(stdout);
}

Cloud onSphere(int count) {
  Random random(1);
  Cloud points;
  for (int i = 0; i < count; ++i) points.push_back(0.2 * random.direction());
  return points;
}

}  // namespace

int main() {
  std::printf(
      "| cloud | points | vertices | seconds, median of 5 | us / (V log2 V) | bytes a vertex "
      "|\n|---|---|---|---|---|---|\n");
  for (int subdivisions = 1; subdivisions <= 5; ++subdivisions)
    row("geodesic sphere", geodesicSphere(0.2, subdivisions));
  for (const int count : {100, 1000, 10000, 100000}) row("random on a sphere", onSphere(count));
  for (const double over : {1e-2, 1e-9}) {
    const Cloud points = onSphere(10000);
    row("random on a sphere, near the smallest R", points, StpBv::smallestR(points, 0.01) * (1 + over));
  }
  row("1000-gon prism", cylinder(0.1, 0.4, 1000));
  row("uniform in a box", randomHull(1000000, {0.3, 0.2, 0.1}, 1));
  Cloud ball = onSphere(1000000);
  Random random(2);
  for (Eigen::Vector3d& p : ball) p *= std::cbrt(random.uniform(0, 1));
  row("uniform in a ball", ball);
  return 0;
}
