// Whether advised radii keep their promises in the scenarios of the controller's bench.
#pragma once

#include <string>
#include <vector>

#include "tools/bench/measurement.h"

namespace fcl_stpbv::benchmark {

/// For each scenario and each of some clearances the advice for what is held, and what runs with
/// it measure. The motion that the advice needs is that of first runs, and a quarter more.
/// @throws Error where runs that moved as stated had more acceleration added than was allowed.
Measurement measureAdvice(const std::vector<std::string>& scenarios, int runs);

}  // namespace fcl_stpbv::benchmark
