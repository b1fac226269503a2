// Counts the allocations of a program that links fcl_stpbv_allocations.
#pragma once

#include <atomic>

namespace fcl_stpbv::test {

/// Number of calls of malloc and similar functions since the program started, in all threads. With
/// sanitizers, of operator new.
extern std::atomic<long> allocations;

}  // namespace fcl_stpbv::test
