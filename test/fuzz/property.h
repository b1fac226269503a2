// Functions with which a target reports that a property does not hold.
#pragma once

#include <cstring>
#include <stdexcept>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv::fuzz {

/// @throws std::logic_error with the text `what` unless `holds`.
inline void must(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

/// Whether the library accepts the call. It may refuse with an Error; any other exception passes on.
template <class Call>
bool accepted(Call call) {
  try {
    call();
    return true;
  } catch (const Error& e) {
    must(std::strlen(e.what()) > 10, "an error without a message");
    return false;
  }
}

}  // namespace fcl_stpbv::fuzz
