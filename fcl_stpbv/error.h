// The only exception type that building and loading throw.
#pragma once

#include <stdexcept>

namespace fcl_stpbv {

/// Thrown by building and loading only, never by a query. The message names the file or the argument at
/// fault and says what would work.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace fcl_stpbv
