// A mask holds for one thread, and the kernel gives a signal of the process to any thread that does not block
// it. So the signals that end a process get a handler at the first write:
// 1. while nobody writes, the handler ends the process at once, and no write begins any more;
// 2. while somebody writes, the handler notes the signal, no further write begins, and the last writer ends
//    the process.
#include "fcl_stpbv/io/signals_held.h"

#include <pthread.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <ctime>

namespace fcl_stpbv::detail {
namespace {

constexpr std::array<int, 2> kSignalsOfWrites = {SIGXFSZ, SIGPIPE};
constexpr std::array<int, 5> kEndingSignals = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU};
constexpr int kEnding = -1;

std::atomic<int> writers{0};  // number of writers, or kEnding
std::atomic<int> noted{0};    // the signal that shall end the process, 0 for none
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler uses them");

extern "C" void noteSignal(int signal);

bool isAction(int signal, void (*handler)(int)) {
  struct sigaction action {};
  return ::sigaction(signal, nullptr, &action) == 0 && (action.sa_flags & SA_SIGINFO) == 0 &&
         action.sa_handler == handler;
}

void setAction(int signal, void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  ::sigaction(signal, &action, nullptr);
}

// Ends the process by this signal. A signal to this thread, which does not block it, is delivered before
// raise() returns.
void endBy(int signal) {
  if (isAction(signal, noteSignal)) setAction(signal, SIG_DFL, 0);
  sigset_t one;
  sigemptyset(&one);
  sigaddset(&one, signal);
  pthread_sigmask(SIG_UNBLOCK, &one, nullptr);
  ::raise(signal);
}

void endIfNobodyWrites() {
  for (int none = 0; noted != 0 && writers.compare_exchange_strong(none, kEnding); none = 0) {
    endBy(noted.exchange(0));
    // The process goes on, because the application's own handler, newer than ours, took the signal.
    writers = 0;
  }
}

extern "C" void noteSignal(int signal) {
  const int error = errno;
  noted = signal;
  endIfNobodyWrites();
  errno = error;
}

void installHandler() {
  // The writers of the parent process do not go on in a forked process.
  static const int forks = pthread_atfork(nullptr, nullptr, [] { writers = 0; });
  static_cast<void>(forks);
  for (const int signal : kEndingSignals)
    if (isAction(signal, SIG_DFL)) setAction(signal, noteSignal, SA_RESTART);
}

}  // namespace

WriteSignalsHeld::WriteSignalsHeld() {
  sigset_t held;
  sigemptyset(&held);
  for (const int signal : kSignalsOfWrites) sigaddset(&held, signal);
  pthread_sigmask(SIG_BLOCK, &held, &before_);
}

WriteSignalsHeld::~WriteSignalsHeld() {
  // A write past the file size limit fails with EFBIG, which the caller reports; the signal that came with
  // it would end the process without a message. The same holds for a pipe without a reader.
  sigset_t reported;
  sigemptyset(&reported);
  for (const int signal : kSignalsOfWrites)
    if (sigismember(&before_, signal) == 0) sigaddset(&reported, signal);
  const timespec now{0, 0};
  while (sigtimedwait(&reported, nullptr, &now) > 0) {
  }
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

EndPutOff::EndPutOff() {
  constexpr useconds_t kMoment = 1000;  // us; the process is about to end
  for (int others = writers;; others = writers) {
    if (noted == 0 && others >= 0 && writers.compare_exchange_strong(others, others + 1)) break;
    ::usleep(kMoment);
  }
  installHandler();  // not earlier: it would undo the default action by which another thread ends the process
}

EndPutOff::~EndPutOff() {
  --writers;
  endIfNobodyWrites();
}

}  // namespace fcl_stpbv::detail
