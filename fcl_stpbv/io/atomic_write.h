// Writes files, and folders of files, atomically: if a write fails or is interrupted, the old ones stay
// unchanged.
#pragma once

#include <iosfwd>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace fcl_stpbv::detail {

/// Puts `content` into `path`: a temporary file in the same folder, fsync, rename. Signals that would end the
/// process are delayed until this is done, in whatever thread they arrive, so Ctrl-C leaves no temporary file
/// behind. A symbolic link is followed, an existing file keeps its permissions. A device, a pipe, or an open
/// descriptor (/dev/stdout, /dev/fd/3) is written directly and can be interrupted.
/// @throws Error naming the file and the reason.
void atomicWrite(const std::string& path, std::string_view content);

struct NamedText {
  std::string path, content;
};

/// Checks before the work that atomicWrite() can write to `path`, and changes nothing. `shown` stands for the
/// path in messages. @throws Error saying what is in the way.
void requireWritable(const std::string& path, const std::string& shown);

/// atomicWrite() for files that belong together: all are written before the first one is renamed to its name.
/// Devices, pipes and descriptors are written before that. @throws Error as above. All files are then
/// unchanged, unless the rename of a later file fails (for example in a folder in which files of other users
/// cannot be replaced). In that case the files renamed before it are new.
void atomicWriteAll(const std::vector<NamedText>& files);

/// atomicWrite() for a file that nobody else may change: only its owner has write permission. If the path is
/// a link or a pipe, the link or pipe is replaced, not written to.
/// @throws Error as above.
void atomicWriteOwn(const std::string& path, std::string_view content);

/// Removes temporary files and folders that killed processes left in `folder` more than an hour ago.
void sweepTemporaries(const std::string& folder);

/// Writes a tool's result: to standard output for "" and "-", else to the file.
/// @throws Error also if standard output cannot be written.
void writeOutput(const std::string& path, std::string_view content);

/// Writes `content` into a caller's stream and flushes it, so that errors such as a full disk are detected.
/// @throws Error naming what the stream is for.
void writeStream(std::ostream& out, std::string_view content, const std::string& what);

/// The contents of files by name. A name may contain folders, as in "meshes/arm.obj".
using FolderFiles = std::map<std::string, std::string>;

/// Makes `folder` hold exactly these files. They are written into a new folder beside it, which is then
/// renamed. The old folder is removed, so the caller must make sure that nothing is lost. The parent folder
/// must exist. Signals that would end the process are delayed meanwhile.
/// @throws Error naming the folder and the reason; the old folder is then unchanged.
void atomicWriteFolder(const std::string& folder, const FolderFiles& files);

/// Tests whether the folder can be created; call it before long work whose result is written there.
/// @throws Error as atomicWriteFolder() does.
void requireFolderPlace(const std::string& folder);

}  // namespace fcl_stpbv::detail
