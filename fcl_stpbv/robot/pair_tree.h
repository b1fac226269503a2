// What the tree of joints and the user's SRDF say about each pair, before anything is measured.
#pragma once

#include <vector>

#include "fcl_stpbv/robot/pair_list.h"

namespace fcl_stpbv::detail {

struct TreePair : LinkPair {
  PairReason reason = PairReason::sometimes;  ///< that of all pairs which the tree leaves open
  bool joined = false;  ///< adjacent, but open, as an SRDF has them checked: searched as others are
};

/// All pairs of links that have bodies, then those of links that move with each of so many obstacles.
std::vector<TreePair> pairsOfTree(const Kinematics& kinematics, const RobotGeometry& geometry,
                                  const Srdf* srdf, std::size_t obstacles);

}  // namespace fcl_stpbv::detail
