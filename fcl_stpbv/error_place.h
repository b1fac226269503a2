// Errors that get a place before them, as they pass through what knows it.
#pragma once

#include <string>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv::detail {

/// What `make` returns; its errors get the place before them, such as a file or a key.
template <class Make>
auto within(const std::string& where, const Make& make) {
  try {
    return make();
  } catch (const Error& error) {
    throw Error(where + ": " + error.what());
  }
}

}  // namespace fcl_stpbv::detail
