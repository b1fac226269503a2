// Writes a file whole or not at all: a failed or interrupted run leaves the old file as it was.
#pragma once

#include <string>
#include <string_view>

namespace fcl_stpbv {

/// Puts `content` into `path`: a temporary file in the same folder, fsync, rename. Signals that would end the
/// process are held back in the calling thread for that moment, so Ctrl-C leaves no temporary file behind (a
/// program with more threads has to block them there itself). A symbolic link is followed, an existing file
/// keeps its permissions; a device or pipe is written straight.
/// @throws Error naming the file and the reason.
void atomicWrite(const std::string& path, std::string_view content);

}  // namespace fcl_stpbv
