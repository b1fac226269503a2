// Summary on the geodesic workload:
// 1. The time of a warm query, and of FCL's query.
// 2. Errors of every 997th answer, compared with the reference.
// 3. The growth of the time from 12 to 2562 vertices.
// 4. The cost of overlap.
// Times are medians over blocks. Ratios are taken block by block.
#include "tools/bench/summary.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/bench/reference_answer.h"
#include "tools/bench/timing.h"

namespace fcl_stpbv::benchmark {

namespace {

constexpr int kBlocks = 300;
constexpr int kCheckEvery = 997;    // prime, so that every part of the motion is checked
constexpr int kCheckedPerRun = 60;  // a reference of a large body takes milliseconds

struct Figures {
  double ns, speedup;
};

/// Ratio of the times of two methods, block by block, because a temporary slowdown of the machine affects
/// both.
double ratio(const Times& one, const Times& other, Summary& summary) {
  std::vector<double> blocks;
  for (std::size_t i = 0; i < one.block.size(); ++i) blocks.push_back(one.block[i] / other.block[i]);
  summary.spread = std::max(summary.spread, spread(blocks));
  return median(blocks);
}

Figures measure(const Bodies& bodies, const Step& step, std::uint64_t seed, Summary& summary, Errors& worst) {
  std::vector<MethodPtr> methods;
  methods.push_back(stpBvWarm(bodies));
  methods.push_back(fclLibccd(bodies));
  GeodesicMotion motion(step, seed);
  long asked = 0;
  int checked = 0;
  const std::vector<Times> times =
      timed(methods, motion, kBlocks, GeodesicMotion::kCycle, false,
            [&](std::size_t method, const Poses& poses, const std::vector<Answer>& answers) {
              if (method != 0) return;
              for (std::size_t i = 0; i < answers.size(); ++i) {
                summary.failed += answers[i].outcome == Outcome::failed;
                if (++asked % kCheckEvery || checked == kCheckedPerRun) continue;
                const Truth truth = smoothTruth(bodies, poses.a[i], poses.b[i]);
                ++checked;
                ++summary.checked;
                if (!truth.proven) {
                  ++summary.unproven;
                  continue;
                }
                const Errors e = errorsOf(answers[i], truth);
                worst = {std::max(worst.distance, e.distance), std::max(worst.normal, e.normal)};
              }
            });
  return {median(times[0].block), ratio(times[1], times[0], summary)};
}

/// Ratio of the times of a warm query with the large bodies and with the small ones. The two take turns. With
/// `besideFcl`, FCL's queries of the large bodies are run in between, which leave little of this library's
/// data in the caches.
double growth(const Bodies& small, const Bodies& large, const Step& step, bool besideFcl, std::uint64_t seed,
              Summary& summary) {
  std::vector<MethodPtr> methods;
  methods.push_back(stpBvWarm(small));
  methods.push_back(stpBvWarm(large));
  if (besideFcl) methods.push_back(fclLibccd(large));
  GeodesicMotion motion(step, seed);
  const std::vector<Times> times = timed(methods, motion, kBlocks, GeodesicMotion::kCycle);
  return ratio(times[1], times[0], summary);
}

/// Cost of a warm query for bodies that overlap, relative to its cost for bodies that are apart: with an
/// overlap of up to both margins, and deeper. Medians.
struct OverlapCost {
  double withinMargins, deeper;
};

OverlapCost overlapCost(const Bodies& bodies, std::uint64_t seed) {
  constexpr int kTimed = 60;  // blocks; each query is timed separately
  std::vector<MethodPtr> methods;
  methods.push_back(stpBvWarm(bodies));
  GeodesicMotion motion(smallStep(), seed);
  const double margins = bodies.a->volume().radii().r + bodies.b->volume().radii().r;
  std::vector<std::size_t> depthOf;  // 0: apart, 1: within the margins, 2: deeper
  std::vector<Times> times = timed(methods, motion, kTimed, GeodesicMotion::kCycle, true,
                                   [&](std::size_t, const Poses&, const std::vector<Answer>& answers) {
                                     for (const Answer& a : answers)
                                       depthOf.push_back(a.distance > 0 ? 0 : a.distance > -margins ? 1 : 2);
                                   });
  std::array<std::vector<double>, 3> ns;
  for (std::size_t i = 0; i < depthOf.size(); ++i) ns[depthOf[i]].push_back(times[0].query[i]);
  const double apart = median(ns[0]);
  return {median(ns[1]) / apart, median(ns[2]) / apart};
}

double rounded(double x, int digits) {
  const double unit = std::pow(10.0, digits);
  return std::round(x * unit) / unit;
}

}  // namespace

Summary summarise(std::uint64_t seed) {
  Summary summary;
  Errors worst{0, 0};
  const auto run = [&](const Bodies& bodies, const Step& step) {
    return measure(bodies, step, seed, summary, worst);
  };
  const Bodies b12 = geodesicSpheres(0), b162 = geodesicSpheres(2), b2562 = geodesicSpheres(4);
  const Figures small12 = run(b12, smallStep()), small162 = run(b162, smallStep()),
                large162 = run(b162, largeStep());
  run(b12, largeStep()), run(b2562, smallStep()), run(b2562, largeStep());  // for their errors
  const auto widestGrowth = [&](bool besideFcl) {
    return std::max(growth(b12, b2562, smallStep(), besideFcl, seed, summary),
                    growth(b12, b2562, largeStep(), besideFcl, seed, summary));
  };
  summary.figures["speedup_small_162"] = rounded(small162.speedup, 2);
  summary.figures["speedup_large_162"] = rounded(large162.speedup, 2);
  summary.figures["speedup_small_12"] = rounded(small12.speedup, 2);
  summary.figures["ns_small_162"] = rounded(small162.ns, 0);
  summary.figures["ns_large_162"] = rounded(large162.ns, 0);
  summary.figures["growth_12_2562"] = rounded(widestGrowth(false), 2);
  summary.figures["growth_12_2562_beside_fcl"] = rounded(widestGrowth(true), 2);
  const OverlapCost overlap = overlapCost(b162, seed);
  summary.figures["cost_within_margins_162"] = rounded(overlap.withinMargins, 2);
  summary.figures["cost_deeper_162"] = rounded(overlap.deeper, 2);
  summary.figures["normal_error_max"] = worst.normal;
  summary.figures["distance_error_max"] = worst.distance;
  return summary;
}

}  // namespace fcl_stpbv::benchmark
