// What the planner found, as a page to look at: the robot along its way
// from the side, and the least distance.
#pragma once

#include <string>

#include "fcl_stpbv/report/trajectory.h"
#include "scene.h"

namespace example {

/// HTML with SVG in it. `figures` is text for its head.
std::string pageOf(const Scene& scene, const fcl_stpbv::report::TrajectoryReport& followed,
                   const std::string& figures);

}  // namespace example
