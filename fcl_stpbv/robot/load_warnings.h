// Warnings about a loaded robot that do not come from a single file. They are whole sentences, used by the
// reports and by Python.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/srdf.h"

namespace fcl_stpbv::detail {

/// Warns of joints whose limits leave no range. Empty if there are none.
std::vector<std::string> stillJoints(const RobotModel& robot);

/// Warns of the joints of a scene, because a scene is static.
std::vector<std::string> stillObstacles(const RobotModel& scene);

/// Warns if an SRDF leaves out no pair of links, such as one with states only. Then links that always touch
/// their neighbours count as collisions.
std::vector<std::string> leavesOutNone(const RobotModel& robot, const RobotGeometry& geometry,
                                       const Srdf& srdf);

/// Warns if smooth covers of primitives have a larger R than the given one, and says what would help, with
/// the option names of the caller. Empty if there are none.
std::vector<std::string> raisedR(const RobotModel& robot, const RobotGeometry& geometry,
                                 const GeometryOptions& options, const std::string& remedy);

/// Warns of meshes that are split and not closed, because their parts cover only their faces. "" if there are
/// none.
std::string openParts(const RobotGeometry& geometry);

}  // namespace fcl_stpbv::detail
