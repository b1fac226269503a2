// Warnings of a report, in addition to those of loading.
#pragma once

#include <string>

#include "fcl_stpbv/report/collision_report.h"
#include "fcl_stpbv/robot/load_warnings.h"

namespace fcl_stpbv::report {

using detail::openParts;

/// A sentence where a margin below 0 (m) lets bodies overlap; "" else.
std::string overlapsAllowed(double margin);

/// Whole sentences for meshes that are not closed, for bodies that meet in the neutral
/// posture (`neutral` is its name, "" for the usual one), for those that no joint moves and that meet an
/// obstacle, and for pairs whose gradient may jump. The report's pairs and fits are there.
std::vector<std::string> reportWarnings(const CollisionReport& report, const std::string& neutral);

}  // namespace fcl_stpbv::report
