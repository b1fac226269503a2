// Instructions of a part of a program, counted if it runs under callgrind as instructions_per_query starts
// it.
#pragma once

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#else  // then the script finds no counts, and says so
#define CALLGRIND_START_INSTRUMENTATION
#define CALLGRIND_STOP_INSTRUMENTATION
#define CALLGRIND_DUMP_STATS_AT(name)
#endif

namespace fcl_stpbv::test {

/// Does the work, and writes its instructions into a profile of this name.
template <class Work>
void counted([[maybe_unused]] const char* name, Work work) {
  CALLGRIND_START_INSTRUMENTATION;
  work();
  CALLGRIND_STOP_INSTRUMENTATION;
  CALLGRIND_DUMP_STATS_AT(name);
}

}  // namespace fcl_stpbv::test
