// Runs a third-party library on a file that may be malicious, in a child process, so that only the child can
// crash.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace fcl_stpbv::detail {

/// Throws the PassingError of a file for which there is not enough memory.
[[noreturn]] void refuseWithoutMemory(const std::string& file);

/// Memory and processor time that a child process may still take, in proportion to the bytes it reads.
class ChildLimits {
 public:
  /// The initial limits: a base amount for any file.
  ChildLimits();
  /// Raises the limits for a file of this many bytes.
  void allow(std::size_t bytes);
  /// Whether this process may not have as much memory as the file may need.
  bool lacksMemory() const { return lacksMemory_; }

 private:
  std::size_t memory_;  // bytes
  double seconds_;
  bool lacksMemory_ = false;
};

/// Runs `work` in a child process and returns what it returns. `name` stands for the file in messages.
/// @throws Error an error that `work` throws, or an error that the file is damaged if the child crashed or
/// exceeded its limits. @throws PassingError if there is no memory, which does not depend on the file.
std::string inChildProcess(const std::string& name, const std::function<std::string(ChildLimits&)>& work);

}  // namespace fcl_stpbv::detail
