// The planner's result as a page: the robot along its path, seen from the side, and the least distance.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/report/trajectory.h"
#include "scene.h"

namespace example {

/// What is said above the pictures.
struct Findings {
  std::string verdict;                          ///< the page's heading
  std::vector<std::vector<std::string>> table;  ///< its first row has the columns' heads
  std::string about;                            ///< the scene and the path, in a few sentences
};

/// HTML with SVG in it.
std::string pageOf(const Scene& scene, const fcl_stpbv::report::TrajectoryReport& followed,
                   const Findings& findings);

}  // namespace example
