// Errors of one run.
#pragma once

#include "fcl_stpbv/error.h"

namespace fcl_stpbv::detail {

/// An error that comes from this run, not from the file: the next run may read the same file. So the file's
/// shape is not wrong, and is not left out as one.
class PassingError : public Error {
 public:
  using Error::Error;
};

}  // namespace fcl_stpbv::detail
