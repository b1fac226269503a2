// Runs an example's main(). An error is reported with its message and exit status 1; arguments that the
// example does not take, and output that cannot be written, with status 2.
#pragma once

#include <cstdio>
#include <exception>

/// `run` returns the exit status. `argument`: what the example may be given, such as "[FOLDER]"; "" for
/// nothing.
template <class Run>
int reported(int argc, char** argv, Run run, const char* argument = "") {
  const int most = argument[0] != 0 ? 1 : 0;
  if (argc - 1 > most || (argc > 1 && argv[1][0] == '-')) {
    std::fprintf(stderr, "usage: %s%s%s\n", argv[0], most > 0 ? " " : "", argument);
    return 2;
  }
  try {
    const int status = run();
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
    std::perror("standard output cannot be written");
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
