// Starts the threads of a loop for its duration.
#include "fcl_stpbv/robot/share_out.h"

#include <algorithm>

#include "fcl_stpbv/robot/worker_pool.h"

namespace fcl_stpbv::detail {

void shareOut(std::size_t count, int threads, const std::function<void(std::size_t)>& each,
              const std::function<void(std::size_t)>& begun) {
  WorkerPool(static_cast<int>(std::min<std::size_t>(count, static_cast<std::size_t>(std::max(1, threads)))))
      .share(
          count, [&](int, std::size_t i) { each(i); }, begun);
}

}  // namespace fcl_stpbv::detail
