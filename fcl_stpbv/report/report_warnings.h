// Warnings of a report, in addition to those of loading.
#pragma once

#include <string>

#include "fcl_stpbv/report/collision_report.h"
#include "fcl_stpbv/robot/load_warnings.h"

namespace fcl_stpbv::report {

using detail::openParts;

/// A sentence if a margin below 0 (m) lets bodies overlap; otherwise "".
std::string overlapsAllowed(double margin);

/// Whole sentences about meshes that are not closed; bodies that meet in the neutral posture (`neutral` is
/// its name, "" for the usual one); bodies that no joint moves and that meet an obstacle; and pairs whose
/// gradient may jump. The report must have its pairs and fits already.
std::vector<std::string> reportWarnings(const CollisionReport& report, const std::string& neutral);

}  // namespace fcl_stpbv::report
