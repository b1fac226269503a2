// Time and memory of building volumes against the number of points: the table of docs/volume.md.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/stp_bv.h"
#include "test/reference/shapes.h"
#include "tools/bench/measurement.h"
#include "tools/program.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using benchmark::significant;

namespace {

nlohmann::ordered_json row(const char* name, const Cloud& points, double R = 10) {
  constexpr int kRuns = 5;
  std::vector<double> seconds;
  StpBv::Ptr volume;
  for (int run = 0; run < kRuns; ++run) {
    const auto begin = std::chrono::steady_clock::now();
    volume = StpBv::build(points, {0.01, R});
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  std::sort(seconds.begin(), seconds.end());
  const double vertices = volume->vertexCount(), median = seconds[kRuns / 2];
  return {{"cloud", name},
          {"points", points.size()},
          {"vertices", volume->vertexCount()},
          {"seconds", significant(median, 3)},
          {"us_per_v_log_v", significant(1e6 * median / (vertices * std::log2(vertices + 1)), 3)},
          {"bytes_per_vertex", std::round(static_cast<double>(volume->memory()) / vertices)}};
}

Cloud onSphere(int count) {
  Random random(1);
  Cloud points;
  for (int i = 0; i < count; ++i) points.push_back(0.2 * random.direction());
  return points;
}

}  // namespace

int main(int argc, char** argv) {
  tools::Program app("Time and memory of building volumes: a JSON object a line", "build_benchmark");
  bool quick = false;
  app.flag("--quick", quick, "clouds of up to 10,000 points only");
  return benchmark::runBenchmark(app, argc, argv, "build", [&](benchmark::Measurement& result) {
    const auto add = [&](const char* name, const Cloud& points, double R = 10) {
      result.add(row(name, points, R));
    };
    for (int subdivisions = 1; subdivisions <= 5; ++subdivisions)
      add("geodesic sphere", geodesicSphere(0.2, subdivisions));
    for (const int count : {100, 1000, 10000}) add("random on a sphere", onSphere(count));
    for (const double over : {1e-2, 1e-9}) {
      const Cloud points = onSphere(10000);
      add("random on a sphere, near the smallest R", points, StpBv::smallestR(points, 0.01) * (1 + over));
    }
    add("1000-gon prism", cylinder(0.1, 0.4, 1000));
    if (!quick) {
      add("random on a sphere", onSphere(100000));
      add("uniform in a box", randomHull(1000000, {0.3, 0.2, 0.1}, 1));
      Cloud ball = onSphere(1000000);
      Random random(2);
      for (Eigen::Vector3d& p : ball) p *= std::cbrt(random.uniform(0, 1));
      add("uniform in a ball", ball);
    }
  });
}
