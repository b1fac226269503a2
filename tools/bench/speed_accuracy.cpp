// Speed and accuracy, this library beside its peers: figures on standard output, or files that
// `tools/bench/draw` makes the charts and tables of docs/performance.md from.
#include "tools/bench/speed_accuracy.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "tools/bench/method.h"
#include "tools/bench/summary.h"
#include "tools/bench/timing.h"

using namespace fcl_stpbv::benchmark;

namespace {

/// Prints the figures of each turn, one JSON object a line; a turn is a run of its own.
int printSummary(std::uint64_t seed, int turns, Measurement& result) {
  result.name = "summary";
  result.about = {{"seed", seed}};
  int failed = 0;
  for (int turn = 0; turn < turns; ++turn) {
    const Summary summary = summarise(seed);
    std::printf("%s\n", summary.figures.dump().c_str());
    std::fprintf(stderr,
                 "%d answers against the long-double reference, %d of them without one (cores overlap); %d "
                 "queries failed\n",
                 summary.checked, summary.unproven, summary.failed);
    if (summary.spread > kQuietSpread)
      std::fprintf(stderr, "the machine was busy: blocks disagree by %.0f %%; do not keep these times\n",
                   100 * summary.spread);
    failed += summary.failed;
    result.spread = std::max(result.spread, summary.spread);
    result.rows.push_back(summary.figures);
  }
  return failed ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Speed and accuracy of STP-BV distances beside FCL's");
  app.set_version_flag("--version", "speed_accuracy " FCL_STPBV_VERSION);
  bool summary = false;
  int turns = 1;
  std::string only, folder;
  SpeedOptions options;
  CLI::Option* figures =
      app.add_flag("--summary", summary, "print the figures as one JSON object, within a minute");
  app.add_option("--turns", turns, "print them so many times")->needs(figures)->check(CLI::PositiveNumber);
  app.add_option("--seed", options.seed, "of the poses")->capture_default_str();
  app.add_option("-o,--output", folder, "folder for the files; without --summary docs/measured");
  app.add_option("--only", only, "one measurement")
      ->check(CLI::IsMember({"jump", "solver", "model", "size"}))
      ->excludes(figures);
  app.add_option("--calls", options.calls, "calls a point of the size chart")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--blocks", options.blocks,
                 "blocks of 840 queries a method of the solver and the model error")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    const std::string command = commandLine(argc, argv);
    if (summary) {
      Measurement result;
      const int status = printSummary(options.seed, turns, result);
      if (!folder.empty()) write(result, command, folder);
      return status;
    }
    if (folder.empty()) folder = "docs/measured";
    if (!bulletGjk(geodesicSpheres(0)))
      std::fprintf(stderr, "built without Bullet (Debian package libbullet-dev): the files leave it out\n");
    struct Entry {
      const char* name;
      Measurement (*measure)(const SpeedOptions&);
    };
    for (const Entry& entry : {Entry{"jump", jumpTest}, Entry{"solver", solverError},
                               Entry{"model", modelError}, Entry{"size", sizeTimes}})
      if (only.empty() || only == entry.name) write(entry.measure(options), command, folder);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "speed_accuracy: %s\n", e.what());
    return 1;
  }
}
