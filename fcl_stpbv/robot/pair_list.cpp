// Results derived from a pair list: the pairs to check, their counts, and entries for an SRDF.
#include "fcl_stpbv/robot/pair_list.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/checked_pairs.h"
#include "fcl_stpbv/robot/link_check.h"

namespace fcl_stpbv {
namespace {

using detail::at;

// The reason in MoveIt's terms. A rigid pair is "Always" or "Never" in collision.
const char* srdfReason(const PairEntry& entry) {
  switch (entry.reason) {
    case PairReason::adjacent:
      return "Adjacent";
    case PairReason::rigid:
      return entry.neutralDistance > 0 ? "Never" : "Always";
    case PairReason::always:
      return "Always";
    case PairReason::neverSampled:
    case PairReason::neverProven:
      return "Never";
    default:
      return "Default";
  }
}

}  // namespace

void requireRoomForPairs(const Kinematics& kinematics, const RobotGeometry& geometry, std::size_t obstacles) {
  // Memory of a pair: a configuration, and a row of the Jacobian with its structure.
  constexpr double kMostBytes = 4e9;
  const double bytes = 1000.0 + 40.0 * kinematics.size();
  const double bodies = static_cast<double>(geometry.bodies.size());
  double pairs = bodies * (bodies - 1) / 2 + bodies * static_cast<double>(obstacles);
  for (std::size_t l = 0; l < kinematics.robot().links.size(); ++l) {
    const auto [first, last] = geometry.of(static_cast<int>(l));
    pairs -= 0.5 * (last - first) * (last - first - 1);  // pairs of bodies of one link
  }
  if (pairs * bytes <= kMostBytes) return;
  throw Error(kinematics.robot().path + ": the " + std::to_string(static_cast<long>(pairs)) + " pairs of " +
              std::to_string(geometry.bodies.size()) + " bodies and " + std::to_string(obstacles) +
              " obstacles do not fit into memory (4 GB); give fewer collision shapes");
}

std::vector<CheckedPair> checkedPairs(const RobotGeometry& geometry, const std::vector<PairEntry>& list) {
  std::vector<CheckedPair> pairs;
  for (const PairEntry& entry : list) {
    if (!checkedWithoutSrdf(entry.reason)) continue;
    const std::vector<CheckedPair> bodies = bodiesOf(geometry, entry);
    pairs.insert(pairs.end(), bodies.begin(), bodies.end());
  }
  return pairs;
}

std::string countsOf(const std::vector<PairEntry>& list) {
  std::map<PairReason, int> counts;
  for (const PairEntry& entry : list) ++counts[entry.reason];
  std::string text;
  for (const auto& [reason, count] : counts)
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + reasonText(reason);
  return text;
}

std::vector<Srdf::Pair> toSrdf(const RobotModel& robot, const std::vector<PairEntry>& list, bool defaultToo) {
  std::vector<Srdf::Pair> pairs;
  for (const PairEntry& entry : list) {
    if (entry.obstacle || entry.reason == PairReason::sometimes || entry.reason == PairReason::user) continue;
    const bool clears = entry.reason == PairReason::defaultClears || entry.reason == PairReason::always;
    if (clears && !defaultToo) continue;
    for (const int link : {entry.link1, entry.link2}) detail::requireLink("toSrdf", link, robot);
    Srdf::Pair pair{robot.links[at(entry.link1)].name, robot.links[at(entry.link2)].name, srdfReason(entry)};
    if (pair.link2 < pair.link1) std::swap(pair.link1, pair.link2);
    pairs.push_back(std::move(pair));
  }
  std::sort(pairs.begin(), pairs.end(), [](const Srdf::Pair& a, const Srdf::Pair& b) {
    return std::tie(a.link1, a.link2) < std::tie(b.link1, b.link2);
  });
  return pairs;
}

}  // namespace fcl_stpbv
