// Properties of the terminal that a program writes to.
#pragma once

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <string>

namespace fcl_stpbv::tools {

/// Columns of the terminal behind a file descriptor; 80 if there is none or the number is unknown.
inline std::size_t columnsOf(int descriptor) {
  winsize size{};
  return ::ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

/// Whether a line can be rewritten: the output is a terminal that supports escape codes.
inline bool canRewrite(int descriptor) {
  const char* const kind = std::getenv("TERM");
  return ::isatty(descriptor) != 0 && kind != nullptr && *kind != '\0' && kind != std::string("dumb");
}

}  // namespace fcl_stpbv::tools
