// See atomic_write.h.
#include "fcl_stpbv/io/atomic_write.h"

#include <fcntl.h>
#include <pthread.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <filesystem>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv {
namespace {

// Holds back the signals that end a process, until the temporary file is renamed or removed.
class SignalsHeld {
 public:
  SignalsHeld() {
    sigset_t held;
    sigemptyset(&held);
    for (int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXFSZ, SIGXCPU, SIGPIPE}) sigaddset(&held, signal);
    pthread_sigmask(SIG_BLOCK, &held, &before_);
  }
  ~SignalsHeld() {
    // A write past the file size limit fails with EFBIG, which the caller reports; the signal that came with
    // it would end the process without a word. The same goes for a pipe nobody reads.
    sigset_t reported;
    sigemptyset(&reported);
    for (int signal : {SIGXFSZ, SIGPIPE}) {
      if (sigismember(&before_, signal) == 0) sigaddset(&reported, signal);
    }
    const timespec now{0, 0};
    while (sigtimedwait(&reported, nullptr, &now) > 0) {
    }
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  SignalsHeld(const SignalsHeld&) = delete;
  SignalsHeld& operator=(const SignalsHeld&) = delete;

 private:
  sigset_t before_;
};

[[noreturn]] void refuse(const std::string& path, int error) {
  throw Error(path + ": cannot be written: " + std::strerror(error));
}

int writeAll(int file, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

void writeStraight(const std::string& path, std::string_view content) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) refuse(path, errno);
  int error = writeAll(file, content);
  if (::close(file) != 0 && error == 0) error = errno;
  if (error != 0) refuse(path, error);
}

// The file that `path` stands for, symbolic links followed even where the last one hangs in the air.
std::string target(const std::string& path) {
  namespace fs = std::filesystem;
  constexpr int kMostLinks = 40;  // what the kernel follows
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
int openBeside(const std::string& path, std::string& name) {
  static std::atomic<unsigned> serial{0};
  for (;;) {
    name = path + ".tmp" + std::to_string(::getpid()) + "-" + std::to_string(serial++);
    const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file >= 0 || errno != EEXIST) return file;
  }
}

// Makes the rename itself survive a power cut. Some file systems cannot; the file is whole all the same.
void syncFolder(const std::string& path) {
  const std::filesystem::path parent = std::filesystem::path(path).parent_path();
  const int folder = ::open(parent.empty() ? "." : parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  ::fsync(folder);
  ::close(folder);
}

}  // namespace

void atomicWrite(const std::string& path, std::string_view content) {
  const SignalsHeld held;
  const std::string file = target(path);
  struct stat old {};
  const bool exists = ::stat(file.c_str(), &old) == 0;
  if (exists && S_ISDIR(old.st_mode)) refuse(path, EISDIR);
  if (exists && !S_ISREG(old.st_mode)) return writeStraight(file, content);
  // A rename would replace a file that its owner made read-only.
  if (exists && ::access(file.c_str(), W_OK) != 0) refuse(path, errno);

  std::string temporary;
  const int out = openBeside(file, temporary);
  if (out < 0) refuse(path, errno);
  int error = writeAll(out, content);
  if (error == 0 && exists && ::fchmod(out, old.st_mode & 07777) != 0) error = errno;
  if (error == 0 && ::fsync(out) != 0) error = errno;
  if (::close(out) != 0 && error == 0) error = errno;
  if (error == 0 && ::rename(temporary.c_str(), file.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    refuse(path, error);
  }
  syncFolder(file);
}

}  // namespace fcl_stpbv
