// The measurements behind docs/performance.md.
#pragma once

#include <cstdint>

#include "tools/bench/measurement.h"

namespace fcl_stpbv::benchmark {

struct SpeedOptions {
  std::uint64_t seed = 1;
  long calls = 200000;  ///< calls per point of the size chart
  /// Blocks of 840 queries per method and motion, for the errors of the solver and the model.
  int blocks = 24;
};

Measurement solverError(const SpeedOptions& options);  ///< time and error of each method at each tolerance
Measurement modelError(const SpeedOptions& options);   ///< over-cover, time and steepness of the gradient
/// Largest change of the gradient on finer and finer paths.
Measurement jumpTest(const SpeedOptions& options);
Measurement sizeTimes(const SpeedOptions& options);  ///< time against vertices (the paper's figure 8)
/// Yes or no for one pair, apart and overlapping.
Measurement verdictTimes(const SpeedOptions& options);

}  // namespace fcl_stpbv::benchmark
