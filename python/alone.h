// Lets one thread at a time use an object while Python's global lock (GIL) is released.
#pragma once

#include <pybind11/pybind11.h>

#include <mutex>

namespace fcl_stpbv {

/// Releases Python's lock first, then waits for the object: a thread that waits holds up no other, and the
/// one that works may take Python's lock in between, as Interrupt does.
class Alone {
 public:
  explicit Alone(std::mutex& object) : object_(object) {}

 private:
  pybind11::gil_scoped_release others_;
  std::lock_guard<std::mutex> object_;  // the first to go
};

}  // namespace fcl_stpbv
