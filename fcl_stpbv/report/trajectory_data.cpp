// See trajectory_data.h.
#include "fcl_stpbv/report/trajectory_data.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/report/pair_measure.h"
#include "fcl_stpbv/report/report_formats.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

nlohmann::json asList(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

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
          {"hull_distance",
           std::isfinite(pair.hullDistance) ? nlohmann::json(pair.hullDistance) : nlohmann::json()},
          {"over_cover1", pair.overCover1},
          {"over_cover2", pair.overCover2},
          {"point1", asList(pair.answer.points[0])},
          {"point2", asList(pair.answer.points[1])},
          {"normal", asList(pair.answer.normal)},
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

bool isUndecided(const CollisionReport& report, const PairReport& pair) {
  if (!report.trajectory || !pair.checked || pair.freeAlong) return false;
  const TrajectoryReport& t = *report.trajectory;
  const bool isFarther = pair.answer.distance - TrajectoryReport::kPrecision > report.margin;
  return !(t.closestProven && isFarther) || t.followedUntil < t.trajectory.time.back() ||
         std::any_of(t.undecided.begin(), t.undecided.end(), [&](const TrajectoryStop& stop) {
           return report.trajectoryPairs[at(stop.pair)] == std::make_pair(pair.link1, pair.link2);
         });
}

}  // namespace fcl_stpbv::report
