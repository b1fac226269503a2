// What a trajectory says of each pair of links: where the two come closest, and what becomes of them.
#pragma once

#include <string>

#include "fcl_stpbv/report/collision_report.h"

namespace fcl_stpbv::report {

/// Follows the bodies of the report's checked pairs along the way points of `trajectory`, read from `path`.
/// Fills the report's trajectory, and the configuration that each pair is reported in: checked ones where
/// they are closest, others at the first way point. @throws Error where no pair is checked.
void followPairs(const Trajectory& trajectory, const std::string& path, CollisionReport& report);

/// "free" where a proof or the closest approach shows that the measured `pair` stays clear all the way,
/// "contact" where it comes within the margin, else "undecided"; "" where it was not followed.
std::string verdictAlong(const CollisionReport& report, const PairReport& pair);

}  // namespace fcl_stpbv::report
