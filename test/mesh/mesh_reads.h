// Shows whether a mesh was read.
#pragma once

#include <sys/resource.h>

namespace fcl_stpbv::test {

/// Number of pages that child processes have touched so far. Meshes are read in children, so if it does not
/// grow, none was read.
inline long pagesOfChildren() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  return usage.ru_minflt;
}

}  // namespace fcl_stpbv::test
