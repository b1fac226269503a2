// Adds a place, such as a file or a key, to the messages of errors that pass through.
#pragma once

#include <string>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv::detail {

/// Returns the result of `make`. If it throws an Error, the place is put before its message.
template <class Make>
auto within(const std::string& where, const Make& make) {
  try {
    return make();
  } catch (const Error& error) {
    throw Error(where + ": " + error.what());
  }
}

}  // namespace fcl_stpbv::detail
