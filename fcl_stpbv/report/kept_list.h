// The pair list of a robot, kept on disk between runs.
#pragma once

#include <memory>
#include <vector>

#include "fcl_stpbv/robot/pair_list.h"
#include "fcl_stpbv/robot/volume_cache.h"

namespace fcl_stpbv::report {

/// As pairList(). A list that the cache holds for the same robot, bodies, obstacles, SRDF and options is not
/// searched for again; one that was cut short by `proofSeconds`, or would be too long, is not kept.
std::vector<PairEntry> keptPairList(const std::shared_ptr<const Kinematics>& kinematics,
                                    const std::shared_ptr<const RobotGeometry>& geometry, const Srdf* srdf,
                                    const PairListOptions& options, detail::VolumeCache& cache);

}  // namespace fcl_stpbv::report
