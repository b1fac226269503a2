// Runs work on an untrusted file in a child process:
// 1. fork with limits on memory and processor time that grow with the files opened;
// 2. the child writes outcome, size and text to a pipe;
// 3. if the child ended by a signal or a limit, or its answer is incomplete, the parent throws an Error that
//    names the file.
#include "fcl_stpbv/mesh/child_process.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/passing_error.h"

namespace fcl_stpbv::detail {
namespace {

// Meshes take at most about 150 bytes of memory and 2 us of processor time per byte (docs/file_formats.md).
constexpr std::size_t kMemory = 256u << 20, kMemoryPerByte = 256;
constexpr double kSeconds = 5, kSecondsPerByte = 5e-6;

// Out of memory: beyond the limits for the file, or because this process may not have as much.
enum Outcome : char { kDone = 'd', kRefused = 'r', kOutOfMemory = 'm', kLacksMemory = 'l' };

std::size_t addressSpace() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

void writeAll(int to, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(to, data, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) ::_exit(1);
    data += written;
    size -= static_cast<std::size_t>(written);
  }
}

/// Writes the outcome, the size of the text, and the text. The size lets the parent notice a child that ended
/// in between.
[[noreturn]] void answer(int to, Outcome outcome, const std::string& text) {
  const std::size_t size = text.size();
  writeAll(to, reinterpret_cast<const char*>(&outcome), 1);
  writeAll(to, reinterpret_cast<const char*>(&size), sizeof size);
  writeAll(to, text.data(), size);
  ::_exit(0);
}

[[noreturn]] void child(int to, const std::function<std::string(ChildLimits&)>& work) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU, SIGPIPE})
    std::signal(signal, SIG_DFL);
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
  ChildLimits limits;
  try {
    answer(to, kDone, work(limits));
  } catch (const std::bad_alloc&) {
    answer(to, limits.lacksMemory() ? kLacksMemory : kOutOfMemory, "");
  } catch (const std::exception& e) {
    answer(to, kRefused, e.what());
  } catch (...) {
    ::_exit(1);
  }
}

std::string readAll(int from) {
  std::string all;
  char buffer[1 << 16];
  for (;;) {
    const ssize_t got = ::read(from, buffer, sizeof buffer);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return all;
    all.append(buffer, static_cast<std::size_t>(got));
  }
}

/// Waits for the child. @returns its signal, or 0 if it ended by itself or somebody else waited for it.
int signalOf(pid_t pid) {
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0)
    if (errno != EINTR) return 0;
  return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

}  // namespace

ChildLimits::ChildLimits() : memory_(addressSpace() + kMemory), seconds_(kSeconds) { allow(0); }

void ChildLimits::allow(std::size_t bytes) {
  memory_ += kMemoryPerByte * bytes;
  seconds_ += kSecondsPerByte * static_cast<double>(bytes);
  // Sets the limit as far as this process's own limits allow it.
  const auto lower = [](auto resource, rlim_t limit) {
    rlimit both{};
    if (::getrlimit(resource, &both) != 0) return false;
    both.rlim_cur = both.rlim_max == RLIM_INFINITY ? limit : std::min(limit, both.rlim_max);
    ::setrlimit(resource, &both);
    return both.rlim_cur < limit;
  };
  lacksMemory_ = lower(RLIMIT_AS, memory_);
  lower(RLIMIT_CPU, static_cast<rlim_t>(std::ceil(seconds_)));
}

void refuseWithoutMemory(const std::string& file) {
  throw PassingError(file + ": memory ran out while it was read; free some, or raise the limit (ulimit -v)");
}

std::string inChildProcess(const std::string& name, const std::function<std::string(ChildLimits&)>& work) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw PassingError(name + ": cannot be read: " + std::strerror(errno));
  const pid_t pid = ::fork();
  if (pid == 0) {
    ::close(ends[0]);
    child(ends[1], work);
  }
  ::close(ends[1]);
  if (pid < 0) {
    const int error = errno;
    ::close(ends[0]);
    if (error == ENOMEM) refuseWithoutMemory(name);
    throw PassingError(name + ": cannot be read: " + std::strerror(error));
  }
  const std::string all = readAll(ends[0]);
  ::close(ends[0]);
  const int signal = signalOf(pid);

  std::size_t size = 0;
  constexpr std::size_t kHead = 1 + sizeof size;
  if (all.size() >= kHead) std::memcpy(&size, all.data() + 1, sizeof size);
  if (all.size() >= kHead && all.size() - kHead == size) {
    std::string text = all.substr(kHead);
    if (all[0] == kDone) return text;
    if (all[0] == kRefused) throw Error(text);
  }
  if (signal == SIGXCPU)
    throw Error(name +
                ": takes more time to read than a file of its size can need; it is damaged, export it again");
  if (!all.empty() && all[0] == kLacksMemory) refuseWithoutMemory(name);
  if (signal == SIGKILL)  // not by its own limits, which raise SIGXCPU or let an allocation fail
    throw PassingError(name + ": its reader was killed, perhaps because memory ran out; run again");
  if (!all.empty() && all[0] == kOutOfMemory)
    throw Error(
        name +
        ": takes more memory to read than a file of its size can need; it is damaged, export it again");
  throw Error(name + ": its reader fell over; the file is damaged, export it again");
}

}  // namespace fcl_stpbv::detail
