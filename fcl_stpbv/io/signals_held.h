// Holds signals back while files are being replaced.
#pragma once

#include <csignal>
#include <initializer_list>

namespace fcl_stpbv::detail {

/// Signals that come with an error of write().
constexpr std::initializer_list<int> kSignalsOfWrites = {SIGXFSZ, SIGPIPE};
/// And those that end a process otherwise.
constexpr std::initializer_list<int> kEndingSignals = {SIGXFSZ, SIGPIPE, SIGINT, SIGTERM,
                                                       SIGHUP,  SIGQUIT, SIGXCPU};

/// Blocks these signals in the calling thread while it lives; they arrive afterwards.
class SignalsHeld {
 public:
  explicit SignalsHeld(std::initializer_list<int> signals);
  ~SignalsHeld();
  SignalsHeld(const SignalsHeld&) = delete;
  SignalsHeld& operator=(const SignalsHeld&) = delete;

 private:
  sigset_t before_;
};

}  // namespace fcl_stpbv::detail
