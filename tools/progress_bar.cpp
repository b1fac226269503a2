// See progress_bar.h.
#include "tools/progress_bar.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace fcl_stpbv::tools {
namespace {

constexpr std::size_t kCells = 24;
constexpr std::size_t kColumns = 80;  // where the terminal does not say

std::size_t columns() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kColumns;
}

}  // namespace

ProgressBar::ProgressBar(std::size_t steps, bool wanted)
    : steps_(steps), active_(wanted && steps > 1 && ::isatty(STDERR_FILENO) != 0) {}

void ProgressBar::show(std::size_t done, const std::string& what) {
  if (!active_) return;
  const std::size_t filled = kCells * std::min(done, steps_) / steps_;
  std::string line = "[" + std::string(filled, '#') + std::string(kCells - filled, '.') + "] " +
                     std::to_string(done) + "/" + std::to_string(steps_) + " " + what;
  // A line that wraps could not be taken away again.
  line.resize(std::min(line.size(), columns() - 1));
  std::fprintf(stderr, "\r\033[K%s", line.c_str());
  std::fflush(stderr);
  shown_ = true;
}

void ProgressBar::clear() {
  if (!shown_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  shown_ = false;
}

}  // namespace fcl_stpbv::tools
