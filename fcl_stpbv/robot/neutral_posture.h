// Whether the neutral configuration is free of collisions, and which posture
// would serve better where it is not.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/robot/pair_list.h"

namespace fcl_stpbv::detail {

struct NeutralPosture {
  int colliding = 0;  ///< pairs of links whose bodies meet there, but for adjacent and rigidly joined ones
  static constexpr std::size_t kNamed = 3;
  std::vector<LinkPair> named;  ///< the first so many of them
  Eigen::VectorXd better;       ///< where fewer do; empty where nothing fewer was found
  std::string state;            ///< the group_state that this is, "" for a random configuration
  int collidingThere = 0;
};

/// The SRDF's postures by name (null for none), each whole, as whoever asks for one gets it. What is no
/// posture, such as a joint with too many values, is not among them: that is told to whoever asks for it.
std::vector<std::pair<std::string, Eigen::VectorXd>> namedPostures(const Kinematics& kinematics,
                                                                   const Srdf* srdf);

/// Counts the pairs of `list` that collide in `neutral`; if there are any, looks at namedPostures(),
/// then at 200 random configurations, for the first with the fewest. The same for the same list.
NeutralPosture judgeNeutral(std::shared_ptr<const Kinematics> kinematics,
                            std::shared_ptr<const RobotGeometry> geometry, const std::vector<PairEntry>& list,
                            const Eigen::VectorXd& neutral, const Srdf* srdf, double margin);

}  // namespace fcl_stpbv::detail
