// Functions that are compiled twice, with and without AVX2 and FMA instructions; the version is chosen when
// the program starts.
#pragma once

/// Put before the definition of a function that makes up a query. The choice is per function: whole
/// translation units with wider instructions would change Eigen's alignment and with it FCL's binary
/// interface. Functions that it calls are inlined into it if the compiler sees their definition. Sanitizers
/// cannot follow the choice and clang 14 does not know it; unoptimised, a call would stay one and its two
/// sides pass vectors differently. FCL_STPBV_PORTABLE leaves it out.
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && defined(__OPTIMIZE__) && \
    !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) &&  \
    !defined(FCL_STPBV_PORTABLE)
#define FCL_STPBV_VECTORIZED __attribute__((flatten, target_clones("arch=x86-64-v3", "default")))
#else
#define FCL_STPBV_VECTORIZED
#endif
