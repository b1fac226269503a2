// A fixed set of threads that wait on a condition variable, so that sharing out work allocates nothing.
#include "fcl_stpbv/robot/worker_pool.h"

#include <algorithm>
#include <exception>

namespace fcl_stpbv::detail {

WorkerPool::WorkerPool(int threads) {
  try {
    for (int k = 1; k < threads; ++k) workers_.emplace_back([this, k] { serve(k); });
  } catch (const std::exception&) {
    // The system cannot start more threads; those that started share the work.
  }
}

WorkerPool::~WorkerPool() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  begin_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

bool WorkerPool::Pieces::take(std::size_t& i) {
  const std::lock_guard<std::mutex> lock(mutex_);
  i = next_;
  if (i == count_) return false;
  ++next_;
  if (begun_) begun_(i);  // under the same lock, so in order
  return true;
}

void WorkerPool::Pieces::fail(std::size_t i) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (i >= firstFailed_) return;
  firstFailed_ = i;
  failure_ = std::current_exception();
}

void WorkerPool::start(Call call, void* work) {
  if (workers_.empty()) {
    call(work, 0);
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    call_ = call;
    work_ = work;
    busy_ = static_cast<int>(workers_.size());
    ++round_;
  }
  begin_.notify_all();
  call(work, 0);
  std::unique_lock<std::mutex> lock(mutex_);
  end_.wait(lock, [this] { return busy_ == 0; });
}

void WorkerPool::serve(int k) {
  unsigned done = 0;
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    begin_.wait(lock, [&] { return stop_ || round_ != done; });
    if (stop_) return;
    done = round_;
    lock.unlock();
    call_(work_, k);
    lock.lock();
    if (--busy_ == 0) end_.notify_one();
  }
}

void shareOut(std::size_t count, int threads, const std::function<void(std::size_t)>& each,
              const std::function<void(std::size_t)>& begun) {
  WorkerPool(static_cast<int>(std::min<std::size_t>(count, static_cast<std::size_t>(std::max(1, threads)))))
      .share(
          count, [&](int, std::size_t i) { each(i); }, begun);
}

}  // namespace fcl_stpbv::detail
