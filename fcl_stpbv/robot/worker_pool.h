// A pool of waiting threads that share work, without allocation during the work.
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace fcl_stpbv::detail {

class WorkerPool {
 public:
  /// `threads` in total, including the caller's own; with 1, no thread is started. Fewer if the system cannot
  /// start them.
  explicit WorkerPool(int threads);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  int threads() const { return static_cast<int>(workers_.size()) + 1; }

  /// Calls `work(k)` once for each k below threads(), each in its own thread, and
  /// waits for all. `work` must not throw.
  template <class Work>
  void run(Work& work) {
    start([](void* w, int k) { (*static_cast<Work*>(w))(k); }, &work);
  }

 private:
  using Call = void (*)(void*, int);
  void start(Call call, void* work);
  void serve(int k);

  std::vector<std::thread> workers_;
  std::mutex mutex_;
  std::condition_variable begin_, end_;
  Call call_ = nullptr;
  void* work_ = nullptr;
  unsigned round_ = 0;
  int busy_ = 0;
  bool stop_ = false;
};

}  // namespace fcl_stpbv::detail
