// Long work without Python's lock, which Ctrl-C ends all the same.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>

namespace fcl_stpbv {

/// Called between two pieces of such work: now and then it looks whether Ctrl-C was pressed.
class Interrupt {
 public:
  /// @throws pybind11::error_already_set after Ctrl-C.
  void operator()() {
    // Taking the lock may take 5 ms where other threads of Python run.
    if (Clock::now() - last_ < std::chrono::milliseconds(100)) return;
    const pybind11::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
    last_ = Clock::now();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

}  // namespace fcl_stpbv
