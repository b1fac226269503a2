// Lets Ctrl-C interrupt long work that runs without Python's global lock (GIL).
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>

namespace fcl_stpbv {

/// Call it between two pieces of such work. From time to time it checks whether Ctrl-C was pressed.
class Interrupt {
 public:
  /// @throws pybind11::error_already_set after Ctrl-C.
  void operator()() {
    // Taking the lock may take 5 ms if other threads of Python run.
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
