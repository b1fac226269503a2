// Number of random trials in the tests' longest loops: an eighth under a sanitizer.
#pragma once

namespace fcl_stpbv::test {

/// Number of random trials of n: all, or an eighth with a sanitizer, because each then takes ten times as
/// long. For the longest loops, which spend most of their time in the reference.
constexpr int trials(int n) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return (n + 7) / 8;
#else
  return n;
#endif
}

}  // namespace fcl_stpbv::test
