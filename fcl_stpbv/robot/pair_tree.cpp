// Sorts all pairs of links by what is known before any distance: an SRDF's reason, rigidly joined, adjacent,
// or open.
#include "fcl_stpbv/robot/pair_tree.h"

#include <string>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/adjacency.h"

namespace fcl_stpbv::detail {

std::vector<TreePair> pairsOfTree(const Kinematics& kinematics, const RobotGeometry& geometry,
                                  const Srdf* srdf, std::size_t obstacles) {
  const RobotModel& robot = kinematics.robot();
  const Adjacency adjacency(robot, geometry);
  const int links = static_cast<int>(robot.links.size());
  const auto none = [&](int link) { return geometry.of(link).first == geometry.of(link).second; };
  std::vector<TreePair> pairs;
  const SkipReasons reasons(srdf);
  for (int i = 0; i < links; ++i) {
    for (int j = i + 1; j < links; ++j) {
      if (none(i) || none(j)) continue;
      const Joining joining = adjacency.of(i, j);
      const std::string skipped = reasons.of(robot.links[at(i)].name, robot.links[at(j)].name);
      const bool joined = srdf && skipped.empty() && joining == Joining::adjacent;
      pairs.push_back({{i, j},
                       skipped == "User"                         ? PairReason::user
                       : joining == Joining::rigid               ? PairReason::rigid
                       : joining == Joining::adjacent && !joined ? PairReason::adjacent
                                                                 : PairReason::sometimes,
                       joined});
    }
  }
  for (int i = 0; i < links; ++i)
    for (std::size_t o = 0; o < obstacles; ++o)
      if (!none(i) && moves(robot, i, kinematics.baseMoves()))
        pairs.push_back({{i, static_cast<int>(o), true}, PairReason::sometimes, false});
  return pairs;
}

}  // namespace fcl_stpbv::detail
