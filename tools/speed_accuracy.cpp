// Speed against accuracy, this library beside its peers: figures as JSON.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>

#include "tools/benchmark/summary.h"
#include "tools/benchmark/timing.h"

using namespace fcl_stpbv::benchmark;

namespace {

int printSummary(std::uint64_t seed) {
  const Summary summary = summarise(seed);
  std::printf("%s\n", summary.figures.dump().c_str());
  std::fprintf(stderr,
               "%d answers against the long-double reference, %d of them without one (cores overlap); %d "
               "queries failed\n",
               summary.checked, summary.unproven, summary.failed);
  if (summary.spread > kQuietSpread)
    std::fprintf(stderr, "the machine was busy: blocks disagree by %.0f %%; do not keep these times\n",
                 100 * summary.spread);
  return summary.failed ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Speed and accuracy of STP-BV distances beside FCL's");
  bool summary = false;
  std::uint64_t seed = 1;
  app.add_flag("--summary", summary, "print the figures as one JSON object, within a minute");
  app.add_option("--seed", seed, "of the poses")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    return printSummary(seed);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "speed_accuracy: %s\n", e.what());
    return 1;
  }
}
