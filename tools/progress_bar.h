// A progress bar on the terminal; silent if standard error is no terminal, or one without escape codes.
#pragma once

#include <cstddef>
#include <string>

namespace fcl_stpbv::tools {

class ProgressBar {
 public:
  /// Shows nothing for a single step, if it is not wanted, or if standard error is not a terminal that can
  /// rewrite a line.
  ProgressBar(std::size_t steps, bool wanted);
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Shows that `done` steps are done, and what is being processed.
  void show(std::size_t done, const std::string& what);
  /// Erases the bar, so that other output can use the line.
  void clear();

 private:
  std::size_t steps_;
  bool active_;
  bool shown_ = false;
};

}  // namespace fcl_stpbv::tools
