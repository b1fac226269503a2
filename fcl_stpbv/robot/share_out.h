// A parallel loop over independent pieces of work.
#pragma once

#include <cstddef>
#include <functional>

namespace fcl_stpbv::detail {

/// Calls `each(i)` once for every i below `count`, by up to `threads` threads, the caller's among them.
/// `begun(i)`, where there is one, is called before each(i), in the order of i and by one thread at a time;
/// it must not throw. All pieces are tried; then the failure of the first of those that failed is thrown,
/// whatever the number of threads.
void shareOut(std::size_t count, int threads, const std::function<void(std::size_t)>& each,
              const std::function<void(std::size_t)>& begun = nullptr);

}  // namespace fcl_stpbv::detail
