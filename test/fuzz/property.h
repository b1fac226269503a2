// How a target says that a property does not hold.
#pragma once

#include <cstring>
#include <stdexcept>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv::fuzz {

/// @throws std::logic_error saying `what` unless it holds.
inline void must(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

/// The library may refuse, in a message; nothing else may come out of it.
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
