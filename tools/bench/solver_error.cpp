// Time against error: each method over its tolerance. Methods without a tolerance are single points.
#include <algorithm>
#include <cmath>
#include <map>

#include "tools/bench/reference_answer.h"
#include "tools/bench/speed_accuracy.h"
#include "tools/bench/timing.h"

namespace fcl_stpbv::benchmark {

namespace {

constexpr std::size_t kPoseStride = 23;  // because the reference of the STP-BVs takes milliseconds
constexpr double kWrong = 1e-6;          // m: FCL's default tolerance

/// The errors of one method, and the number of answers that it missed.
struct Record {
  std::vector<double> distance, normal;
  int checked = 0, wrong = 0, missed = 0;

  void add(const Answer& answer, const Truth& truth, bool smooth) {
    ++checked;
    // Polyhedra that are apart must be found apart. STP-BVs may overlap within their margins, and then they
    // have an answer.
    if (answer.outcome == Outcome::failed || (!smooth && answer.outcome != Outcome::apart)) {
      ++missed;
      return;
    }
    const Errors e = errorsOf(answer, truth);
    if (!std::isfinite(e.distance) || !std::isfinite(e.normal)) {
      ++missed;
      return;
    }
    wrong += e.distance > kWrong;
    distance.push_back(e.distance);
    normal.push_back(e.normal);
  }
};

std::vector<MethodPtr> allMethods(const Bodies& bodies) {
  std::vector<MethodPtr> methods;
  for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    methods.push_back(fclLibccd(bodies, tolerance));
    methods.push_back(fclIndep(bodies, tolerance));
  }
  if (MethodPtr bullet = bulletGjk(bodies)) methods.push_back(std::move(bullet));
  methods.push_back(fclGapStop(bodies, false));
  methods.push_back(fclGapStop(bodies, true));
  methods.push_back(stpBvThroughFcl(bodies));
  methods.push_back(stpBvWarm(bodies));
  return methods;
}

/// The reference answers of one block, each computed when it is first needed.
class BlockTruths {
 public:
  explicit BlockTruths(const Bodies& bodies) : bodies_(bodies) {}
  const Truth& of(const Poses& poses, std::size_t i, bool smooth) {
    if (!poses_ || poses_->a[0].matrix() != poses.a[0].matrix()) {
      truths_.clear();
      poses_ = std::make_unique<Poses>(poses);
    }
    const auto [entry, isNew] = truths_.try_emplace({i, smooth});
    if (isNew)
      entry->second = smooth ? smoothTruth(bodies_, poses.a[i], poses.b[i])
                             : polyhedralTruth(bodies_, poses.a[i], poses.b[i]);
    return entry->second;
  }

 private:
  const Bodies& bodies_;
  std::unique_ptr<Poses> poses_;
  std::map<std::pair<std::size_t, bool>, Truth> truths_;
};

}  // namespace

Measurement solverError(const SpeedOptions& options) {
  Measurement result;
  result.name = "solver_error";
  const Bodies bodies = geodesicSpheres(2);
  result.about = {{"seed", options.seed}, {"vertices", bodies.a->volume().vertexCount()}};
  for (const Step& step : {smallStep(), largeStep()}) {
    const std::vector<MethodPtr> methods = allMethods(bodies);
    std::vector<Record> records(methods.size());
    BlockTruths truths(bodies);
    GeodesicMotion motion(step, options.seed);
    std::vector<Times> times =
        timed(methods, motion, options.blocks, GeodesicMotion::kCycle, true,
              [&](std::size_t m, const Poses& poses, const std::vector<Answer>& answers) {
                for (std::size_t i = 0; i < answers.size(); i += kPoseStride) {
                  const Truth& truth = truths.of(poses, i, methods[m]->smooth);
                  if (truth.proven) records[m].add(answers[i], truth, methods[m]->smooth);
                }
              });
    for (std::size_t m = 0; m < methods.size(); ++m) {
      Record& r = records[m];
      std::vector<double>& ns = times[m].query;
      const double apart = spread(times[m].block);
      result.spread = std::max(result.spread, apart);
      nlohmann::ordered_json row{{"steps", step.name},
                                 {"method", methods[m]->name},
                                 {"setting", methods[m]->setting},
                                 {"ns_p5", std::round(percentile(ns, 0.05))},
                                 {"ns_p50", std::round(percentile(ns, 0.5))},
                                 {"ns_p99", std::round(percentile(ns, 0.99))}};
      for (const auto& [what, errors] :
           {std::pair{"distance_error", &r.distance}, {"normal_error", &r.normal}})
        for (const auto& [share, p] : {std::pair{"_p50", 0.5}, {"_p99", 0.99}, {"_max", 1.0}})
          row[std::string(what) + share] = significant(percentile(*errors, p), 2);
      row["queries"] = ns.size();
      row["checked"] = r.checked;
      row["off_by_more_than_1e-6"] = r.wrong;
      row["missed"] = r.missed;
      row["spread"] = significant(apart, 2);
      result.rows.push_back(std::move(row));
    }
  }
  return result;
}

}  // namespace fcl_stpbv::benchmark
