// Writes a file whole or not at all: a failed or interrupted run leaves the old file as it was.
#pragma once

#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace fcl_stpbv::detail {

/// Puts `content` into `path`: a temporary file in the same folder, fsync, rename. Signals that would end the
/// process are held back in the calling thread for that moment, so Ctrl-C leaves no temporary file behind (a
/// program with more threads has to block them there itself). A symbolic link is followed, an existing file
/// keeps its permissions. A device, a pipe, or an open descriptor (/dev/stdout, /dev/fd/3) is written
/// straight and can be interrupted.
/// @throws Error naming the file and the reason.
void atomicWrite(const std::string& path, std::string_view content);

struct NamedText {
  std::string path, content;
};

/// The same for files that belong together: none gets its name before all are written. No devices or pipes.
/// @throws Error as above; then all are as they were, but for those that had got their names where another
/// one's was refused only then, as in a folder that lets nobody replace files of others.
void atomicWriteAll(const std::vector<NamedText>& files);

/// The same for a file that nobody else may change: only its owner may write it, and whatever has its name, a
/// link or a pipe, is replaced rather than written to.
/// @throws Error as above.
void atomicWriteOwn(const std::string& path, std::string_view content);

/// Removes temporary files that killed processes left in `folder` more than an hour ago.
void sweepTemporaries(const std::string& folder);

/// Where a tool's result goes: to standard output for "" and "-", else to the file.
/// @throws Error also where standard output cannot be written.
void writeOutput(const std::string& path, std::string_view content);

/// Puts `content` into a caller's stream, all of it at once, so that one which is full tells.
/// @throws Error naming what the stream is for.
void writeStream(std::ostream& out, std::string_view content, const std::string& what);

}  // namespace fcl_stpbv::detail
