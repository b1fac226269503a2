// Checks whether advised radii keep their promises in the scenarios of the controller's benchmark.
#pragma once

#include <string>
#include <vector>

#include "tools/bench/measurement.h"

namespace fcl_stpbv::benchmark {

/// Adds a row for each scenario and each of some clearances: the advised radii of the held solid, and the
/// measurements of runs with them. The motion for the advice is that of first runs, plus a quarter.
/// @throws Error if runs that moved within the stated limits had more added acceleration than allowed.
void measureAdvice(const std::vector<std::string>& scenarios, int runs, Measurement& result);

}  // namespace fcl_stpbv::benchmark
