// A disk cache for a robot's pair list and for the check of its neutral posture.
#pragma once

#include <memory>
#include <vector>

#include "fcl_stpbv/robot/neutral_posture.h"
#include "fcl_stpbv/robot/pair_list.h"
#include "fcl_stpbv/robot/volume_cache.h"

namespace fcl_stpbv::report {

/// pairList() with a cache. A stored list is used if robot, bodies, obstacles, SRDF and options are the same.
/// A list whose proofs were interrupted by `proofSeconds`, or which is too long, is not stored.
std::vector<PairEntry> keptPairList(const std::shared_ptr<const Kinematics>& kinematics,
                                    const std::shared_ptr<const RobotGeometry>& geometry, const Srdf* srdf,
                                    const PairListOptions& options, detail::VolumeCache& cache);

/// judgeNeutral() of such a list, with the same cache.
detail::NeutralPosture keptNeutral(const std::shared_ptr<const Kinematics>& kinematics,
                                   const std::shared_ptr<const RobotGeometry>& geometry,
                                   const std::vector<PairEntry>& list, const Srdf* srdf,
                                   const PairListOptions& options, detail::VolumeCache& cache);

}  // namespace fcl_stpbv::report
