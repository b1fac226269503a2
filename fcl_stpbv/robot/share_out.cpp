// Threads take the next piece as soon as they are done with the last one.
#include "fcl_stpbv/robot/share_out.h"

#include <algorithm>
#include <exception>
#include <mutex>

#include "fcl_stpbv/robot/worker_pool.h"

namespace fcl_stpbv::detail {

void shareOut(std::size_t count, int threads, const std::function<void(std::size_t)>& each,
              const std::function<void(std::size_t)>& begun) {
  std::mutex mutex;
  std::size_t next = 0, firstFailed = count;
  std::exception_ptr failure;
  // Tells of the piece under the same lock, so in order. `i` is taken even where that throws.
  const auto take = [&](std::size_t& i) {
    const std::lock_guard<std::mutex> lock(mutex);
    i = next;
    if (i == count) return false;
    ++next;
    if (begun) begun(i);
    return true;
  };
  auto work = [&](int) {
    for (std::size_t i = 0; i < count;) {
      try {
        if (!take(i)) return;
        each(i);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (i >= firstFailed) continue;
        firstFailed = i;
        failure = std::current_exception();
      }
    }
  };
  WorkerPool(static_cast<int>(std::min<std::size_t>(count, static_cast<std::size_t>(std::max(1, threads)))))
      .run(work);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace fcl_stpbv::detail
