// See trajectory_data.h.
#include "fcl_stpbv/report/trajectory_data.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/report/json_values.h"
#include "fcl_stpbv/report/pair_measure.h"
#include "fcl_stpbv/report/report_formats.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

// The pair that touches first, as it is then.
nlohmann::json contactOf(const CollisionReport& report, std::size_t i, std::size_t posture) {
  const TrajectoryReport& t = *report.trajectory;
  PairReport pair = report.pairs[i];
  pair.configuration = t.stop.configuration;
  measurePair(report, bodiesOf(*report.geometry, pair.links), pair);
  return {{"label", "First contact"},
          {"pair", i},
          {"posture", posture},
          {"time_text", t.timeText(t.stop.until)},
          {"time_share", t.share(t.stop.until)},
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
  std::map<LinkPair, std::size_t> number;
  for (std::size_t i = 0; i < report.pairs.size(); ++i) number[report.pairs[i].links] = i;
  nlohmann::json chart{{"distance", t.chartDistance}};
  for (std::size_t k = 0; k < t.chartTime.size(); ++k) {
    chart["share"].push_back(t.share(t.chartTime[k]));
    chart["time_text"].push_back(t.timeText(t.chartTime[k]));
    chart["pair"].push_back(number.at(report.trajectoryPairs[at(t.chartPair[k])]));
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
                                indexOf(t.stop.configuration));
  return data;
}

}  // namespace fcl_stpbv::report
