// Runs a third-party library on a file that may be malicious, in a child process, so that only the child can
// crash.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace fcl_stpbv::detail {

/// Memory and processor time that a child process may still take, in proportion to the bytes it reads.
class ChildLimits {
 public:
  /// The initial limits: a base amount for any file.
  ChildLimits();
  /// Raises the limits for a file of this many bytes.
  void allow(std::size_t bytes);

 private:
  std::size_t memory_;  // bytes
  double seconds_;
};

/// Runs `work` in a child process and returns what it returns. `name` stands for the file in messages.
/// @throws Error an error that `work` throws, or an error that the file is damaged if the child crashed or
/// exceeded its limits.
std::string inChildProcess(const std::string& name, const std::function<std::string(ChildLimits&)>& work);

}  // namespace fcl_stpbv::detail
