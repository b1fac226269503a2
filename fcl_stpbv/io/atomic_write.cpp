// Atomic writes:
// 1. a temporary file in the target's folder, with the old file's permissions;
// 2. write, fsync, rename over the target, fsync the folder;
// 3. signals that would end the process wait until this is done, in whatever thread they arrive.
// Devices, pipes and open descriptors are written directly.
#include "fcl_stpbv/io/atomic_write.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <ostream>
#include <vector>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/signals_held.h"
#include "fcl_stpbv/io/temporary_name.h"

namespace fcl_stpbv::detail {
namespace {

int writeAll(int file, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0 && errno == EAGAIN) {  // the pipe is full and does not block; its reader is slow
      pollfd space{file, POLLOUT, 0};
      ::poll(&space, 1, -1);
      continue;
    }
    if (written < 0) return errno;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

// Opening a pipe waits for its reader, and writing to a full one waits for space. Both can be interrupted.
void writeStraight(const std::string& path, std::string_view content) {
  const WriteSignalsHeld held;
  const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) refuseWrite(path, errno);
  int error = writeAll(file, content);
  if (::close(file) != 0 && error == 0) error = errno;
  if (error != 0) refuseWrite(path, error);
}

// The number of an open descriptor that the path names, or -1.
int descriptorOf(const std::string& path) {
  if (path == "/dev/stdout") return STDOUT_FILENO;
  if (path == "/dev/stderr") return STDERR_FILENO;
  for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
    if (path.compare(0, folder.size(), folder) != 0) continue;
    int number = -1;
    const char* const end = path.data() + path.size();
    const auto result = std::from_chars(path.data() + folder.size(), end, number);
    return result.ec == std::errc() && result.ptr == end ? number : -1;
  }
  return -1;
}

// The file that `path` stands for. Symbolic links are followed, even if the last one leads to no file.
std::string target(const std::string& path) {
  namespace fs = std::filesystem;
  constexpr int kMostLinks = 40;  // the kernel's limit
  fs::path file = path;
  std::error_code error;
  for (int i = 0; i < kMostLinks && fs::is_symlink(file, error); ++i) {
    const fs::path next = fs::read_symlink(file, error);
    if (error) break;
    file = next.is_absolute() ? next : file.parent_path() / next;
  }
  return file.string();
}

// A new file beside `path`; its name is left in `name`.
int openBeside(const std::string& path, mode_t mode, std::string& name) {
  for (;;) {
    name = temporaryBeside(path);
    const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (file >= 0 || errno != EEXIST) return file;
  }
}

// Makes the rename itself survive a power failure. Some file systems cannot do that; the file is complete
// anyway.
void syncFolder(const std::string& path) {
  const int folder = ::open(folderOf(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  ::fsync(folder);
  ::close(folder);
}

// A file whose content is complete and that only has to get its final name.
struct Whole {
  std::string temporary, file;
};

// `old` is the file to be replaced, whose permissions are kept; or null.
Whole writeBeside(const std::string& file, std::string_view content, mode_t mode, const struct stat* old) {
  std::string temporary;
  const int out = openBeside(file, mode, temporary);
  if (out < 0) refuseWrite(file, errno);
  int error = writeAll(out, content);
  if (error == 0 && old && ::fchmod(out, old->st_mode & 07777) != 0) error = errno;
  if (error == 0 && ::fsync(out) != 0) error = errno;
  if (::close(out) != 0 && error == 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    refuseWrite(file, error);
  }
  return {temporary, file};
}

void putInPlace(const Whole& whole) {
  if (::rename(whole.temporary.c_str(), whole.file.c_str()) != 0) {
    const int error = errno;
    ::unlink(whole.temporary.c_str());
    refuseWrite(whole.file, error);
  }
  syncFolder(whole.file);
}

// Whether anything exists at `path`, and what it is. Throws if it is a folder or must not be written.
bool findOld(const std::string& path, struct stat& old) {
  if (path.empty()) throw Error("the name of a file to write is empty; give one");
  if (::stat(path.c_str(), &old) != 0) return false;
  if (S_ISDIR(old.st_mode)) refuseWrite(path, EISDIR);
  // A rename would replace a file that its owner made read-only.
  if (S_ISREG(old.st_mode) && ::access(path.c_str(), W_OK) != 0) refuseWrite(path, errno);
  return true;
}

}  // namespace

void atomicWrite(const std::string& path, std::string_view content) {
  const int descriptor = descriptorOf(path);
  if (descriptor >= 0) {
    const WriteSignalsHeld held;
    if (const int error = writeAll(descriptor, content)) refuseWrite(path, error);
    return;
  }
  struct stat old {};
  const bool exists = findOld(path, old);
  if (exists && !S_ISREG(old.st_mode)) return writeStraight(path, content);
  const EndPutOff putOff;
  putInPlace(writeBeside(target(path), content, 0666, exists ? &old : nullptr));
}

void requireWritable(const std::string& path, const std::string& shown) {
  if (descriptorOf(path) >= 0) return;
  const auto requireRight = [&](const std::string& name, int right) {
    if (::faccessat(AT_FDCWD, name.c_str(), right, AT_EACCESS) != 0) refuseWrite(shown, errno);
  };
  struct stat old {};
  if (::stat(path.c_str(), &old) == 0) {
    if (S_ISDIR(old.st_mode)) throw Error(shown + ": is a folder, expected a file");
    requireRight(path, W_OK);
    if (!S_ISREG(old.st_mode)) return;
  }
  const std::string file = target(path), folder = folderOf(file);
  struct stat place {};
  for (std::string at = folder; ::stat(folder.c_str(), &place) != 0; at = folderOf(at)) {
    const int error = errno;
    if (error != ENOENT && error != ENOTDIR) refuseWrite(shown, error);
    struct stat above {};
    if (::stat(at.c_str(), &above) != 0) continue;
    if (!S_ISDIR(above.st_mode)) throw Error(shown + ": " + at + " is a file, expected a folder");
    throw Error(shown + ": " + (file == path ? "" : "leads to " + file + ", but ") + "the folder " + folder +
                " does not exist; make it first");
  }
  if (!S_ISDIR(place.st_mode)) throw Error(shown + ": " + folder + " is a file, expected a folder");
  requireRight(folder, W_OK | X_OK);
  const long longest = ::pathconf(folder.c_str(), _PC_NAME_MAX);
  const std::size_t length = file.size() - (file.find('/') == std::string::npos ? 0 : folder.size() + 1);
  if (longest > 0 && length > static_cast<std::size_t>(longest)) refuseWrite(shown, ENAMETOOLONG);
}

void atomicWriteAll(const std::vector<NamedText>& files) {
  std::vector<const NamedText*> regular;
  for (const NamedText& file : files) {
    struct stat old {};
    const bool straight = descriptorOf(file.path) >= 0 || (findOld(file.path, old) && !S_ISREG(old.st_mode));
    if (straight)
      atomicWrite(file.path, file.content);
    else
      regular.push_back(&file);
  }
  const EndPutOff putOff;
  std::vector<Whole> written;
  try {
    for (const NamedText* file : regular) {
      struct stat old {};
      const bool exists = findOld(file->path, old);
      written.push_back(writeBeside(target(file->path), file->content, 0666, exists ? &old : nullptr));
    }
    for (const Whole& whole : written) putInPlace(whole);
  } catch (...) {  // files that are in place have no temporary names any more
    for (const Whole& whole : written) ::unlink(whole.temporary.c_str());
    throw;
  }
}

void atomicWriteOwn(const std::string& path, std::string_view content) {
  const EndPutOff putOff;
  putInPlace(writeBeside(path, content, 0600, nullptr));
}

void sweepTemporaries(const std::string& folder) {
  namespace fs = std::filesystem;
  constexpr auto kOld = std::chrono::hours(1);  // no write takes that long
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (!isTemporary(at->path().filename().string())) continue;
    std::error_code ignored;
    const auto age = fs::file_time_type::clock::now() - fs::last_write_time(at->path(), ignored);
    if (!ignored && age > kOld) fs::remove_all(at->path(), ignored);
  }
}

void writeOutput(const std::string& path, std::string_view content) {
  atomicWrite(path.empty() || path == "-" ? "/dev/stdout" : path, content);
}

void writeStream(std::ostream& out, std::string_view content, const std::string& what) {
  if (!out.write(content.data(), static_cast<std::streamsize>(content.size())).flush())
    throw Error("the stream for " + what + " cannot be written");
}

}  // namespace fcl_stpbv::detail
