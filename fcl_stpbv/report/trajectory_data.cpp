// See trajectory_data.h.
#include "fcl_stpbv/report/trajectory_data.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/report/json_values.h"
#include "fcl_stpbv/report/pair_measure.h"
#include "fcl_stpbv/report/report_formats.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

std::size_t pairAt(const CollisionReport& report, int row) {
  const std::pair<std::string, std::string>& names = report.trajectoryPairs[at(row)];
  const auto found = std::find_if(report.pairs.begin(), report.pairs.end(), [&](const PairReport& pair) {
    return pair.checked && pair.link1 == names.first && pair.link2 == names.second;
  });
  return static_cast<std::size_t>(found - report.pairs.begin());
}

// The pair that touches first, as it is then.
nlohmann::json contactOf(const CollisionReport& report, std::size_t i, std::size_t posture) {
  const TrajectoryReport& t = *report.trajectory;
  PairReport pair = report.pairs[i];
  pair.configuration = t.at(t.stop.until);
  measurePair(report, bodiesOf(*report.geometry, pair.links), pair);
  const double begin = t.trajectory.time.front(), end = t.trajectory.time.back();
  return {{"label", "First contact"},
          {"pair", i},
          {"posture", posture},
          {"time_text", t.timeText(t.stop.until)},
          {"time_share", (t.stop.until - begin) / (end - begin)},
          {"distance", pair.answer.distance},
          {"hull_distance", orNull(pair.hullDistance)},
          {"over_cover1", pair.overCover1},
          {"over_cover2", pair.overCover2},
          {"point1", numbers(pair.answer.points[0])},
          {"point2", numbers(pair.answer.points[1])},
          {"normal", numbers(pair.answer.normal)},
          {"gradient", pair.gradient}};
}

}  // namespace

nlohmann::json trajectoryData(const CollisionReport& report,
                              const std::function<std::size_t(const Eigen::VectorXd&)>& indexOf) {
  if (!report.trajectory) return {};
  const TrajectoryReport& t = *report.trajectory;
  nlohmann::json chart{{"time", t.chartTime}, {"distance", t.chartDistance}};
  for (std::size_t k = 0; k < t.chartTime.size(); ++k) {
    chart["time_text"].push_back(t.timeText(t.chartTime[k]));
    chart["pair"].push_back(pairAt(report, t.chartPair[k]));
    chart["posture"].push_back(indexOf(t.at(t.chartTime[k])));
  }
  nlohmann::json data{{"file", t.path},
                      {"timed", t.trajectory.timed},
                      {"verdict", trajectoryVerdict(report)},
                      {"chart", std::move(chart)},
                      {"contact", nullptr}};
  const auto first = std::find_if(report.pairs.begin(), report.pairs.end(),
                                  [](const PairReport& pair) { return pair.stopsTrajectory; });
  if (t.verdict == MotionVerdict::contact && first != report.pairs.end())
    data["contact"] = contactOf(report, static_cast<std::size_t>(first - report.pairs.begin()),
                                indexOf(t.at(t.stop.until)));
  return data;
}

}  // namespace fcl_stpbv::report
