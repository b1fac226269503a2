// Tells whether a mesh was read.
#pragma once

#include <sys/resource.h>

namespace fcl_stpbv::test {

/// Pages that child processes have touched so far: meshes are read in children, so without a page none was.
inline long pagesOfChildren() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  return usage.ru_minflt;
}

}  // namespace fcl_stpbv::test
