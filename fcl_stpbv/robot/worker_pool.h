// A pool of waiting threads that share pieces of work, without allocation during the work.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
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

  /// Calls `each(k, i)` once for every piece i below `count`, in some thread k below threads(), and waits for
  /// all. Threads take the next piece as soon as they are done with the last one. `begun(i)`, where there is
  /// one, is called before, in the order of i and by one thread at a time. All pieces are tried; then what
  /// the first of those that failed has thrown is thrown again, whatever the number of threads.
  template <class Each>
  void share(std::size_t count, const Each& each, const std::function<void(std::size_t)>& begun = nullptr) {
    Pieces pieces(count, begun);
    auto work = [&](int k) {
      for (std::size_t i = 0; i < count;) {
        try {
          if (!pieces.take(i)) return;
          each(k, i);
        } catch (...) {
          pieces.fail(i);
        }
      }
    };
    start([](void* w, int k) { (*static_cast<decltype(work)*>(w))(k); }, &work);
    pieces.rethrow();
  }

 private:
  /// The pieces that are left, and what the first one that failed has thrown.
  class Pieces {
   public:
    Pieces(std::size_t count, const std::function<void(std::size_t)>& begun)
        : count_(count), firstFailed_(count), begun_(begun) {}
    /// The next piece; false if none is left. It is taken even if `begun` throws.
    bool take(std::size_t& i);
    /// Keeps the current exception, which piece i has thrown.
    void fail(std::size_t i);
    void rethrow() const {
      if (failure_) std::rethrow_exception(failure_);
    }

   private:
    std::mutex mutex_;
    std::size_t count_, next_ = 0, firstFailed_;
    std::exception_ptr failure_;
    const std::function<void(std::size_t)>& begun_;
  };

  using Call = void (*)(void*, int);
  /// Calls `call(work, k)` once for each k below threads(), each in its own thread, and waits for all.
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

/// Calls `each(i)` as WorkerPool::share() does, with up to `threads` threads for this call alone.
void shareOut(std::size_t count, int threads, const std::function<void(std::size_t)>& each,
              const std::function<void(std::size_t)>& begun = nullptr);

}  // namespace fcl_stpbv::detail
