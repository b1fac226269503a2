// See allocations.h: operator new and delete of the whole program, with a count.
#include "test/reference/allocations.h"

#include <cstdlib>
#include <new>

std::atomic<long> fcl_stpbv::test::allocations{0};

void* operator new(std::size_t size) {
  ++fcl_stpbv::test::allocations;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {  // as std::stable_sort asks
  ++fcl_stpbv::test::allocations;
  return std::malloc(size);
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
