// Tries situations in which distance codes fail on every available method. Prints the number of failures, or
// writes a file with every case, from which `tools/bench/draw` makes the tables and the picture of
// docs/stability.md.
#include <cstdio>
#include <exception>
#include <filesystem>

#include "test/reference/source_folder.h"
#include "test/reference/stability/contestant.h"
#include "test/reference/stability/suite.h"
#include "tools/bench/measurement.h"
#include "tools/program.h"

using namespace fcl_stpbv::stability;

namespace {

/// The published cases: in the source tree, or where an installed tool finds them.
std::string hardCases() {
  const std::string source = fcl_stpbv::test::sourceFolder() + "/data/hard_cases";
  std::error_code ignored;
  if (std::filesystem::is_directory(source, ignored)) return source;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", ignored);
  return self.parent_path().parent_path() / "share/fcl_stpbv/hard_cases";
}

/// Lists the cases in which a method fails on standard error.
void listFailures(const Results& results, const std::string& id) {
  for (std::size_t m = 0; m < results.methods.size(); ++m)
    for (std::size_t i = 0; i < results.situations.size(); ++i)
      if (results.methods[m].id == id && isFailure(results.of[m][i].verdict))
        std::fprintf(stderr, "%s: %s: %s: %s, placement %d\n", id.c_str(),
                     results.situations[i].group.c_str(), results.situations[i].name.c_str(),
                     results.of[m][i].text().c_str(), results.of[m][i].placement);
}

}  // namespace

int main(int argc, char** argv) {
  fcl_stpbv::tools::Program app("Where distance codes break: every method on every hard case", "stability");
  bool json = false;
  std::uint64_t seed = 1;
  std::string folder = "docs/measured", list;
  std::vector<std::string> only, methods;
  for (const Method& method : allMethods()) methods.push_back(method.id);
  app.flag("--json", json, "only print the number of cases and each method's failures, within a minute");
  app.option("--seed", seed, "of whatever is random in the cases").whole().shown();
  app.option("-o,--output", folder, "folder for stability.json").shown();
  app.option("--method", only, "only these methods").oneOf(methods);
  app.option("--list", list, "print this method's failures, case by case").oneOf(methods);
  return app.run(argc, argv, [&] {
    if (!json) fcl_stpbv::benchmark::requirePlace(folder, "stability");
    const Results results = runSuite(allSituations(seed, hardCases(), !json), only);
    listFailures(results, list);
    std::printf("%s\n", summary(results).dump().c_str());
    if (!json) {
      fcl_stpbv::benchmark::Measurement measurement;
      measurement.name = "stability";
      measurement.about = {{"seed", seed}, {"methods", methodNames(results)}};
      measurement.rows = caseRows(results);
      fcl_stpbv::benchmark::write(measurement, fcl_stpbv::benchmark::commandLine(argc, argv), folder);
    }
    return 0;
  });
}
