// Errors of one run, and errors of the files that shapes come from.
#pragma once

#include <string>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv::detail {

/// An error that comes from this run, not from the file: the next run may read the same file. So the file's
/// shape is not wrong, and is not left out as one.
class PassingError : public Error {
 public:
  using Error::Error;
};

/// Throws the PassingError of a file that somebody saved while it was read.
[[noreturn]] inline void refuseChanged(const std::string& file) {
  throw PassingError(file + ": changed while it was read; run again");
}

/// Returns the result of `make`. If it throws an Error, the file's name is put before its message, unless the
/// message contains it already. A PassingError stays as it is.
template <class Make>
auto namingFile(const std::string& file, const Make& make) {
  try {
    return make();
  } catch (const PassingError&) {
    throw;
  } catch (const Error& error) {
    const std::string message = error.what();
    throw Error(message.find(file) != std::string::npos ? message : file + ": " + message);
  }
}

/// Runs `make`. Returns the message of the Error that it throws, after the shape's place, or "" if it throws
/// none. A PassingError is no fault of the shape and passes.
template <class Make>
std::string shapeFault(const std::string& place, const Make& make) {
  try {
    make();
    return "";
  } catch (const PassingError&) {
    throw;
  } catch (const Error& error) {
    return place + ": " + error.what();
  }
}

}  // namespace fcl_stpbv::detail
