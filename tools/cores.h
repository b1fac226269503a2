// How many threads a tool takes where nobody says how many.
#pragma once

#include <algorithm>
#include <thread>

namespace fcl_stpbv::tools {

/// All cores that this process may use, at least 1.
inline int allCores() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

constexpr int kMostJobs = 256;  // more threads than a machine has cores only cost memory

}  // namespace fcl_stpbv::tools
