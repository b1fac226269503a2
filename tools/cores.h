// The number of threads that a tool uses by default.
#pragma once

#include <algorithm>
#include <thread>

namespace fcl_stpbv::tools {

/// All cores that this process may use, at least 1.
inline int allCores() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

constexpr int kMostJobs = 256;  // more threads than a machine has cores only need memory

}  // namespace fcl_stpbv::tools
