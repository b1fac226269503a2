// Output formats of a collision report.
#pragma once

#include <string>

#include "fcl_stpbv/report/collision_report.h"
#include "fcl_stpbv/report/task_marks.h"

namespace fcl_stpbv::report {

/// For people: a summary and the first `top` lines of each list, the closest pairs first.
std::string toText(const CollisionReport& report, std::size_t top);

/// The table of pairs in that text. If any pair collides, it shows the distance of the meshes and the cause
/// in place of the distance of the hulls and the search's reason.
std::string pairsText(const CollisionReport& report, std::size_t top);
/// The verdict on the report's trajectory: proven free, or which pair touches when.
std::string trajectoryVerdict(const CollisionReport& report);
std::string toJson(const CollisionReport& report);
std::string toCsv(const CollisionReport& report);
/// The robot's SRDF with the pairs that need no check. If shapes of the robot were left out, pairs that do
/// not collide without these shapes are not among them.
std::string toSrdfText(const CollisionReport& report, bool defaultToo = false);
/// The change by this SRDF, in a few words: how many of all pairs of links it leaves out, and how many the
/// SRDF that was read left out.
std::string srdfChange(const CollisionReport& report, bool defaultToo = false);
/// One page with all it needs inside: table, heat map, and the robot in 3-D.
/// The title follows the robot's name. `violated`: a line for each thing that keeps a posture from being
/// feasible; `marks`: what its task asks for.
std::string toHtml(const CollisionReport& report, const std::string& title = "",
                   const std::vector<std::string>& violated = {}, const TaskMarks& marks = {});

}  // namespace fcl_stpbv::report
