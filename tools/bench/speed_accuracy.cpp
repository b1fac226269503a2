// Speed and accuracy of this library and of its peers: figures on standard output, or files from which
// `tools/bench/draw` makes the charts and tables of docs/performance.md.
#include "tools/bench/speed_accuracy.h"

#include <cstdio>
#include <exception>
#include <string>

#include "tools/bench/method.h"
#include "tools/bench/summary.h"
#include "tools/bench/timing.h"
#include "tools/program.h"

using namespace fcl_stpbv::benchmark;

namespace {

/// Prints the figures of each turn, one JSON object per line. Each turn is a run of its own.
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
  fcl_stpbv::tools::Program app("Speed and accuracy of STP-BV distances beside FCL's", "speed_accuracy");
  bool summary = false;
  int turns = 1;
  std::string only, folder;
  SpeedOptions options;
  const fcl_stpbv::tools::Option figures =
      app.flag("--summary", summary, "print the figures as one JSON object, within a minute");
  app.option("--turns", turns, "print them so many times").needs(figures).whole(1);
  app.option("--seed", options.seed, "of the poses").whole().shown();
  app.option("-o,--output", folder, "folder for the files; without --summary docs/measured");
  app.option("--only", only, "one measurement")
      .oneOf({"jump", "solver", "model", "size", "verdict"})
      .excludes(figures);
  app.option("--calls", options.calls, "calls a point of the size chart").shown().whole(1);
  app.option("--blocks", options.blocks,
             "blocks of 840 queries a method of the solver and the model error, of 175 of verdicts")
      .shown()
      .whole(1);
  return app.run(argc, argv, [&] {
    const std::string command = commandLine(argc, argv);
    if (folder.empty() && !summary) folder = "docs/measured";
    requirePlace(folder, "summary");
    if (summary) {
      Measurement result;
      const int status = printSummary(options.seed, turns, result);
      if (!folder.empty()) write(result, command, folder);
      return status;
    }
    if (!bulletGjk(geodesicSpheres(0)))
      std::fprintf(stderr, "built without Bullet (Debian package libbullet-dev): the files leave it out\n");
    struct Entry {
      const char* name;
      Measurement (*measure)(const SpeedOptions&);
    };
    for (const Entry& entry :
         {Entry{"jump", jumpTest}, Entry{"solver", solverError}, Entry{"model", modelError},
          Entry{"size", sizeTimes}, Entry{"verdict", verdictTimes}})
      if (only.empty() || only == entry.name) write(entry.measure(options), command, folder);
    return 0;
  });
}
