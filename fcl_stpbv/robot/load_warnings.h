// What a loaded robot is to be warned of that no single file shows: whole sentences, as the reports and
// Python tell them.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/srdf.h"

namespace fcl_stpbv::detail {

/// Of joints without a range between their limits; none where there are none.
std::vector<std::string> stillJoints(const RobotModel& robot);

/// Of all joints of a scene, which stands still.
std::vector<std::string> stillObstacles(const RobotModel& scene);

/// Where an SRDF leaves out no pair of links, as one that holds states alone: it is obeyed, and neighbours
/// that always touch count as collisions.
std::vector<std::string> leavesOutNone(const RobotModel& robot, const RobotGeometry& geometry,
                                       const Srdf& srdf);

/// Where smooth covers of primitives have a larger R than the one that was given, and what would help, in the
/// words of who asked; none without.
std::vector<std::string> raisedR(const RobotModel& robot, const RobotGeometry& geometry,
                                 const GeometryOptions& options, const std::string& remedy);

/// Of meshes that are split and not closed, whose parts cover their faces alone; "" without one.
std::string openParts(const RobotGeometry& geometry);

}  // namespace fcl_stpbv::detail
