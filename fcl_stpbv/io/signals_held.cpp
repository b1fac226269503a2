// Signals of failed writes are taken here, all others arrive when the mask is put back.
#include "fcl_stpbv/io/signals_held.h"

#include <pthread.h>

#include <ctime>

namespace fcl_stpbv::detail {

SignalsHeld::SignalsHeld(std::initializer_list<int> signals) {
  sigset_t held;
  sigemptyset(&held);
  for (const int signal : signals) sigaddset(&held, signal);
  pthread_sigmask(SIG_BLOCK, &held, &before_);
}

SignalsHeld::~SignalsHeld() {
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

}  // namespace fcl_stpbv::detail
