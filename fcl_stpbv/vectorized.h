// Functions that are compiled twice, with and without AVX2 and FMA instructions; the version is chosen when
// the program starts.
#pragma once

/// Put before the definition of a function that makes up a query. The choice is made for each function: whole
/// translation units with wider instructions would change Eigen's alignment and with it FCL's binary
/// interface. Functions that such a function calls are inlined into it if the compiler sees their definition.
/// The macro is empty where the choice does not work: sanitizers cannot follow it, clang 14 does not know it,
/// and without optimisation calls are not inlined, so that caller and callee would pass vectors differently.
/// FCL_STPBV_PORTABLE makes it empty, too.
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && defined(__OPTIMIZE__) && \
    !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) &&  \
    !defined(FCL_STPBV_PORTABLE)
#define FCL_STPBV_VECTORIZED __attribute__((flatten, target_clones("arch=x86-64-v3", "default")))
#else
#define FCL_STPBV_VECTORIZED
#endif
