// Runs an example's main() and reports an error: its message, and exit status 1.
#pragma once

#include <cstdio>
#include <exception>

template <class Run>
int reported(Run run) {
  try {
    return run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
