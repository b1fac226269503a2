// MUMPS, IPOPT's linear solver, allocates memory for every factorisation and frees it afterwards.
#pragma once

#include <malloc.h>

namespace fcl_stpbv::benchmark {

/// By default, glibc returns MUMPS's memory to the system each time, which makes up a third of the time of
/// small programs.
inline void keepFreedMemory() {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
}

}  // namespace fcl_stpbv::benchmark
