// Holds signals back while files are being replaced.
#pragma once

#include <csignal>

namespace fcl_stpbv::detail {

/// Blocks the signals that come with an error of write(), SIGPIPE and SIGXFSZ, in the calling thread while it
/// lives, and takes those that came: the caller reports the error.
class WriteSignalsHeld {
 public:
  WriteSignalsHeld();
  ~WriteSignalsHeld();
  WriteSignalsHeld(const WriteSignalsHeld&) = delete;
  WriteSignalsHeld& operator=(const WriteSignalsHeld&) = delete;

 private:
  sigset_t before_;
};

/// And puts off the end of the process by SIGINT, SIGTERM, SIGHUP, SIGQUIT or SIGXCPU, whichever thread they
/// arrive in, until no thread holds one any more. The first one gives these signals a handler, which stays;
/// those that the application handles or ignores are left to it. A thread holds one at a time.
class EndPutOff {
 public:
  EndPutOff();
  ~EndPutOff();
  EndPutOff(const EndPutOff&) = delete;
  EndPutOff& operator=(const EndPutOff&) = delete;

 private:
  WriteSignalsHeld writes_;
};

}  // namespace fcl_stpbv::detail
