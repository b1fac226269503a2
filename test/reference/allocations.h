// Counts the allocations of a program that links fcl_stpbv_allocations.
#pragma once

#include <atomic>

namespace fcl_stpbv::test {

/// Calls of malloc and its like since the program started, in all threads; with sanitizers of operator new.
extern std::atomic<long> allocations;

}  // namespace fcl_stpbv::test
