// Checks whether the neutral configuration has collisions, and suggests a better posture if it has.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/robot/pair_list.h"

namespace fcl_stpbv::detail {

struct NeutralPosture {
  /// Number of pairs of links that collide there, without adjacent and rigidly joined ones.
  int colliding = 0;
  static constexpr std::size_t kNamed = 3;
  std::vector<LinkPair> named;  ///< the first kNamed of them
  Eigen::VectorXd better;       ///< a configuration with fewer collisions; empty if none was found
  std::string state;            ///< the group_state that `better` is, "" for a random configuration
  int collidingThere = 0;
};

/// All postures of the SRDF (null for none) by name, as complete configurations. Invalid ones, such as a
/// state with too many values for a joint, are left out; they are reported when they are used.
std::vector<std::pair<std::string, Eigen::VectorXd>> namedPostures(const Kinematics& kinematics,
                                                                   const Srdf* srdf);

/// Counts the pairs of `list` that collide in `neutral`. If there are any, searches namedPostures() and then
/// 200 random configurations for the first with the fewest. The same list always gives the same result.
NeutralPosture judgeNeutral(std::shared_ptr<const Kinematics> kinematics,
                            std::shared_ptr<const RobotGeometry> geometry, const std::vector<PairEntry>& list,
                            const Eigen::VectorXd& neutral, const Srdf* srdf, double margin);

}  // namespace fcl_stpbv::detail
