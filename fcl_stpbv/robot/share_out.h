// A parallel loop over independent pieces of work.
#pragma once

#include <cstddef>
#include <functional>

namespace fcl_stpbv::detail {

/// Calls `each(i)` once for every i below `count`, by up to `threads` threads, the caller's among them.
/// `begun(i)`, where there is one, is called before each(i), in the order of i and by one thread at a time.
/// All pieces are tried; then what the first of those that failed has thrown is thrown again
/// (WorkerPool::share).
void shareOut(std::size_t count, int threads, const std::function<void(std::size_t)>& each,
              const std::function<void(std::size_t)>& begun = nullptr);

}  // namespace fcl_stpbv::detail
