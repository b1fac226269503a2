// What a program may know of the terminal that it writes to.
#pragma once

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <string>

namespace fcl_stpbv::tools {

/// Columns of the terminal behind a file descriptor; 80 where there is none, or it does not say.
inline std::size_t columnsOf(int descriptor) {
  winsize size{};
  return ::ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

/// Whether a line that is there can be written anew: a terminal, and one that knows escape codes.
inline bool canRewrite(int descriptor) {
  const char* const kind = std::getenv("TERM");
  return ::isatty(descriptor) != 0 && kind != nullptr && *kind != '\0' && kind != std::string("dumb");
}

}  // namespace fcl_stpbv::tools
