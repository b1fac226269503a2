// Time against the number of vertices: the paper's figure 8.
#include <algorithm>
#include <cmath>

#include "tools/bench/speed_accuracy.h"
#include "tools/bench/timing.h"

namespace fcl_stpbv::benchmark {

namespace {

/// If a method needs more than this number of seconds per point, it answers fewer calls. The file contains
/// their number.
constexpr double kSecondsAPoint = 10;

}  // namespace

Measurement sizeTimes(const SpeedOptions& options) {
  Measurement result;
  result.name = "size";
  result.about = {{"seed", options.seed}, {"most_calls", options.calls}};
  for (const Step& step : {smallStep(), largeStep()})
    for (int subdivisions = 0; subdivisions <= 5; ++subdivisions) {
      const Bodies bodies = geodesicSpheres(subdivisions);
      const std::vector<MethodPtr> methods = peers(bodies);
      GeodesicMotion motion(step, options.seed);
      std::vector<int> failed(methods.size());
      const int blocks = std::max(1, static_cast<int>(options.calls / GeodesicMotion::kCycle));
      std::vector<Times> times = timed(
          methods, motion, blocks, GeodesicMotion::kCycle, true,
          [&](std::size_t m, const Poses&, const std::vector<Answer>& answers) {
            for (const Answer& a : answers) failed[m] += a.outcome == Outcome::failed;
          },
          kSecondsAPoint);
      for (std::size_t m = 0; m < methods.size(); ++m) {
        std::vector<double>& ns = times[m].query;
        const double apart = spread(times[m].block);
        result.spread = std::max(result.spread, apart);
        result.rows.push_back({{"steps", step.name},
                               {"vertices", bodies.a->volume().vertexCount()},
                               {"method", methods[m]->name},
                               {"setting", methods[m]->setting},
                               {"ns_p5", std::round(percentile(ns, 0.05))},
                               {"ns_p50", std::round(percentile(ns, 0.5))},
                               {"ns_p99", std::round(percentile(ns, 0.99))},
                               {"ns_mean", std::round(median(times[m].block))},
                               {"calls", ns.size()},
                               {"failed", failed[m]},
                               {"spread", significant(apart, 2)}});
      }
    }
  return result;
}

}  // namespace fcl_stpbv::benchmark
