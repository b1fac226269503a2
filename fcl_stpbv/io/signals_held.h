// Delays signals while files are being replaced.
#pragma once

#include <csignal>

namespace fcl_stpbv::detail {

/// Blocks SIGPIPE and SIGXFSZ, which accompany errors of write(), in the calling thread during its lifetime,
/// and discards them. The caller reports the error of write() instead.
class WriteSignalsHeld {
 public:
  WriteSignalsHeld();
  ~WriteSignalsHeld();
  WriteSignalsHeld(const WriteSignalsHeld&) = delete;
  WriteSignalsHeld& operator=(const WriteSignalsHeld&) = delete;

 private:
  sigset_t before_;
};

/// Delays the end of the process by SIGINT, SIGTERM, SIGHUP, SIGQUIT or SIGXCPU, in whatever thread they
/// arrive, until no object of this class exists in any thread. The first object installs a handler for these
/// signals, which stays installed. Signals that the application handles or ignores are not changed. A thread
/// may have only one object at a time.
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
