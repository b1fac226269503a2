// The pair list of a robot and what is said of its neutral posture, kept on disk between runs.
#pragma once

#include <memory>
#include <vector>

#include "fcl_stpbv/robot/neutral_posture.h"
#include "fcl_stpbv/robot/pair_list.h"
#include "fcl_stpbv/robot/volume_cache.h"

namespace fcl_stpbv::report {

/// As pairList(). A list that the cache holds for the same robot, bodies, obstacles, SRDF and options is not
/// searched for again; one that was cut short by `proofSeconds`, or would be too long, is not kept.
std::vector<PairEntry> keptPairList(const std::shared_ptr<const Kinematics>& kinematics,
                                    const std::shared_ptr<const RobotGeometry>& geometry, const Srdf* srdf,
                                    const PairListOptions& options, detail::VolumeCache& cache);

/// As judgeNeutral() of such a list, kept likewise.
detail::NeutralPosture keptNeutral(const std::shared_ptr<const Kinematics>& kinematics,
                                   const std::shared_ptr<const RobotGeometry>& geometry,
                                   const std::vector<PairEntry>& list, const Srdf* srdf,
                                   const PairListOptions& options, detail::VolumeCache& cache);

}  // namespace fcl_stpbv::report
