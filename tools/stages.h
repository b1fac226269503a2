// The progress of a run with several stages, with one bar for each.
#pragma once

#include <memory>
#include <string>

#include "tools/progress_bar.h"

namespace fcl_stpbv::tools {

/// To be used by `std::ref()` as the progress of GeometryOptions and of PairListOptions. The number of a
/// stage's steps is known only when it begins.
class Stages {
 public:
  explicit Stages(bool wanted) : wanted_(wanted) {}
  void operator()(std::size_t done, std::size_t all, const std::string& what) {
    if (!bar_ || all != all_) bar_.reset();
    all_ = all;
    if (!bar_) bar_ = std::make_unique<ProgressBar>(all, wanted_);
    bar_->show(done, what);
  }
  void clear() { bar_.reset(); }

 private:
  bool wanted_;
  std::size_t all_ = 0;
  std::unique_ptr<ProgressBar> bar_;
};

}  // namespace fcl_stpbv::tools
