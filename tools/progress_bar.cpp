// See progress_bar.h.
#include "tools/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "fcl_stpbv/text_cells.h"
#include "tools/terminal.h"

namespace fcl_stpbv::tools {

ProgressBar::ProgressBar(std::size_t steps, bool wanted)
    : steps_(steps), active_(wanted && steps > 1 && canRewrite(STDERR_FILENO)) {}

void ProgressBar::show(std::size_t done, const std::string& what) {
  if (!active_) return;
  const std::size_t columns = columnsOf(STDERR_FILENO);
  const std::size_t cells = std::min<std::size_t>(24, columns * 3 / 10);  // the name needs room too
  const std::size_t filled = cells * std::min(done, steps_) / steps_;
  std::string line = "[" + std::string(filled, '#') + std::string(cells - filled, '.') + "] " +
                     std::to_string(done) + "/" + std::to_string(steps_) + " " + what;
  line = detail::fittedInto(columns - 1, line);  // a wrapped line could not be erased
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
