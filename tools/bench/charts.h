// The four measurements behind docs/performance.md.
#pragma once

#include <cstdint>

#include "tools/bench/chart.h"

namespace fcl_stpbv::benchmark {

struct ChartOptions {
  std::uint64_t seed = 1;
  long calls = 1000000;  ///< a point of the size chart
};

Chart solverErrorChart(const ChartOptions& options);  ///< time against error, over each method's tolerance
Chart modelErrorChart(const ChartOptions& options);   ///< over-cover against time and gradient's steepness
Chart jumpChart(const ChartOptions& options);  ///< largest change of the gradient on finer and finer paths
Chart sizeChart(const ChartOptions& options);  ///< time against vertices (the paper's figure 8)

}  // namespace fcl_stpbv::benchmark
