// Random tasks for the HRP-2-style robot: reaching into a fridge, over and under tables, into shelves, and
// between the legs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fcl_stpbv/posture/task.h"

namespace fcl_stpbv::tools {

struct RandomTask {
  std::string family;  ///< fridge, table, shelves or legs
  PostureTask task;
  std::vector<Obstacle> obstacles;  ///< boxes, cylinders and spheres
};

/// The task of a seed, the same on every machine. A task need not have a solution.
RandomTask randomTask(std::uint64_t seed);

}  // namespace fcl_stpbv::tools
