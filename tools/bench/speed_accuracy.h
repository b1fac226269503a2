// The measurements behind docs/performance.md.
#pragma once

#include <cstdint>

#include "tools/bench/measurement.h"

namespace fcl_stpbv::benchmark {

struct SpeedOptions {
  std::uint64_t seed = 1;
  long calls = 200000;  ///< a point of the size chart
  int blocks = 24;      ///< of 840 queries, a method and motion of the solver and the model error
};

Measurement solverError(const SpeedOptions& options);  ///< time and error of each method at each tolerance
Measurement modelError(const SpeedOptions& options);   ///< over-cover beside time and gradient's steepness
Measurement jumpTest(
    const SpeedOptions& options);  ///< largest change of the gradient on finer and finer paths
Measurement sizeTimes(const SpeedOptions& options);  ///< time against vertices (the paper's figure 8)

}  // namespace fcl_stpbv::benchmark
