// Updates the pair list of a robot after some of its bodies were replaced.
#pragma once

#include <memory>
#include <set>
#include <vector>

#include "fcl_stpbv/robot/pair_list.h"

namespace fcl_stpbv::detail {

/// As pairList(), but only the pairs of `changed` are searched. All others keep their entries of `before`,
/// which must be a list of the same robot with the same SRDF and options. A new search would give the same
/// entries, except for proofs that ran out of time.
std::vector<PairEntry> pairListAgain(std::shared_ptr<const Kinematics> kinematics,
                                     std::shared_ptr<const RobotGeometry> geometry, const Srdf* srdf,
                                     const PairListOptions& options, const std::vector<PairEntry>& before,
                                     const std::set<LinkPair>& changed);

}  // namespace fcl_stpbv::detail
