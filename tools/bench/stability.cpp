// The situations in which distance codes break, tried on every method at hand: a table, a picture, or a
// count.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "test/reference/source_folder.h"
#include "test/reference/stability/suite.h"

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

void writeText(const std::filesystem::path& path, const std::string& content) {
  std::ofstream file(path);
  file << content;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path.string());
  std::fprintf(stderr, "wrote %s\n", path.c_str());
}

void draw(const Results& results, const std::filesystem::path& svg) {
  FILE* gnuplot = popen("gnuplot", "w");
  if (!gnuplot) throw std::runtime_error("cannot start gnuplot");
  const std::string script = strip(results, svg.string());
  const bool sent = std::fwrite(script.data(), 1, script.size(), gnuplot) == script.size();
  if (pclose(gnuplot) != 0 || !sent)
    throw std::runtime_error("the picture needs gnuplot: install the Debian package gnuplot-nox");
  std::fprintf(stderr, "wrote %s\n", svg.c_str());
}

/// Where a method fails: case by case, on standard error.
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
  CLI::App app("Where distance codes break: every method on every hard case");
  app.set_version_flag("--version", "stability " FCL_STPBV_VERSION);
  bool json = false;
  std::uint64_t seed = 1;
  std::string folder = "docs", list;
  std::vector<std::string> only;
  app.add_flag("--json", json, "print the number of cases and each method's failures, within a minute");
  app.add_option("--seed", seed, "of whatever is random in the cases")->capture_default_str();
  app.add_option("-o,--output", folder, "folder for the table and, below it, the picture")
      ->capture_default_str();
  app.add_option("--method", only, "only these methods");
  app.add_option("--list", list, "print this method's failures, case by case");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    const Results results = runSuite(allSituations(seed, hardCases(), !json), only);
    listFailures(results, list);
    if (json) {
      std::printf("%s\n", summary(results).dump().c_str());
    } else {
      const std::filesystem::path images = std::filesystem::path(folder) / "images";
      std::filesystem::create_directories(images);
      std::printf("%s", markdown(results).c_str());
      writeText(images / "stability.csv", csv(results));
      draw(results, images / "stability.svg");
    }
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "stability: %s\n", e.what());
    return 1;
  }
}
