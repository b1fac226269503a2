// Speed against accuracy, this library beside its peers: figures as JSON, or charts.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>

#include "tools/bench/charts.h"
#include "tools/bench/method.h"
#include "tools/bench/summary.h"
#include "tools/bench/timing.h"

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

int drawCharts(const std::string& only, const std::string& folder, const ChartOptions& options, bool force) {
  requireGnuplot();
  if (!bulletGjk(geodesicSpheres(0)))
    std::fprintf(stderr, "built without Bullet (Debian package libbullet-dev): the charts leave it out\n");
  struct Entry {
    const char* name;
    Chart (*measure)(const ChartOptions&);
  };
  bool written = true;
  for (const Entry& entry : {Entry{"jump", jumpChart}, Entry{"solver", solverErrorChart},
                             Entry{"model", modelErrorChart}, Entry{"size", sizeChart}})
    if (only.empty() || only == entry.name) written = write(entry.measure(options), folder, force) && written;
  return written ? 0 : 3;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Speed and accuracy of STP-BV distances beside FCL's");
  app.set_version_flag("--version", "speed_accuracy " FCL_STPBV_VERSION);
  bool summary = false;
  bool force = false;
  std::string only, folder = "docs/images";
  ChartOptions options;
  app.add_flag("--summary", summary, "print the figures as one JSON object, within a minute");
  app.add_option("--seed", options.seed, "of the poses")->capture_default_str();
  app.add_option("-o,--output", folder, "folder for the charts and their CSV")->capture_default_str();
  app.add_option("--only", only, "one chart")->check(CLI::IsMember({"jump", "solver", "model", "size"}));
  app.add_option("--calls", options.calls, "calls a point of the size chart")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_flag("--force", force, "replace earlier charts even by those of a busy machine");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    return summary ? printSummary(options.seed) : drawCharts(only, folder, options, force);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "speed_accuracy: %s\n", e.what());
    return 1;
  }
}
