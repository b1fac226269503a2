// How many random trials a test's longest loops make: an eighth under a sanitizer.
#pragma once

namespace fcl_stpbv::test {

/// How many of n random trials to make: all of them, or an eighth where a sanitizer makes each take ten times
/// as long. For the longest loops, most of whose time is the reference's.
constexpr int trials(int n) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return (n + 7) / 8;
#else
  return n;
#endif
}

}  // namespace fcl_stpbv::test
