// A progress bar on the terminal; silent where standard error is none, or one without escape codes.
#pragma once

#include <cstddef>
#include <string>

namespace fcl_stpbv::tools {

class ProgressBar {
 public:
  /// Shows nothing for a single step, when not wanted, or when standard error is no terminal that can
  /// take a line back.
  ProgressBar(std::size_t steps, bool wanted);
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Shows that `done` steps are behind and what is being worked on.
  void show(std::size_t done, const std::string& what);
  /// Takes the bar away, for other output to have the line.
  void clear();

 private:
  std::size_t steps_;
  bool active_;
  bool shown_ = false;
};

}  // namespace fcl_stpbv::tools
