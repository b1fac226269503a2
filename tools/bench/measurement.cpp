// Files of measurements: one JSON object with one row per line, so that a changed figure is one line of a
// diff.
#include "tools/bench/measurement.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/io/atomic_write.h"

namespace fcl_stpbv::benchmark {

namespace {

using namespace detail;

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

std::string compiler() {
#if defined(__clang__)
  return "clang++ " + std::to_string(__clang_major__) + "." + std::to_string(__clang_minor__);
#else
  return "g++ " + std::to_string(__GNUC__) + "." + std::to_string(__GNUC_MINOR__);
#endif
}

}  // namespace

void Measurement::add(nlohmann::ordered_json row) {
  std::printf("%s\n", row.dump().c_str());
  std::fflush(stdout);
  rows.push_back(std::move(row));
}

void Measurement::print() const {
  for (const auto& row : rows) std::printf("%s\n", row.dump().c_str());
}

int runBenchmark(tools::Program& program, int argc, char** argv, const std::string& name,
                 const std::function<void(Measurement&)>& measure) {
  Measurement result;
  result.name = name;
  std::string folder;
  program.option("-o,--output", folder, "folder for the JSON file");
  program.option("--name", result.name, "its name").shown();
  return program.run(argc, argv, [&] {
    requirePlace(folder, result.name);
    measure(result);
    if (!folder.empty()) write(result, commandLine(argc, argv), folder);
    return 0;
  });
}

std::string commandLine(int argc, char** argv) {
  std::string line = std::filesystem::path(argv[0]).filename().string();
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "-o" || word == "--output")
      ++i;
    else if (word.rfind("-o", 0) != 0 && word.rfind("--output=", 0) != 0)
      line += " " + word;
  }
  return line;
}

double threadTime() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e9 * static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec);
}

std::vector<std::vector<double>> passesInTurns(int passes, std::size_t count,
                                               const std::vector<std::function<void(std::size_t)>>& ways) {
  std::vector<std::vector<double>> times(ways.size());
  for (int pass = 0; pass < passes; ++pass)
    for (std::size_t k = 0; k < ways.size(); ++k) {
      const double start = threadTime();
      for (std::size_t i = 0; i < count; ++i) ways[k](i);
      times[k].push_back((threadTime() - start) / static_cast<double>(count));
    }
  return times;
}

std::vector<double> mediansInTurns(int passes, std::size_t count,
                                   const std::vector<std::function<void(std::size_t)>>& ways) {
  std::vector<double> middle;
  for (const std::vector<double>& each : passesInTurns(passes, count, ways)) middle.push_back(median(each));
  return middle;
}

double percentile(std::vector<double>& values, double p) {
  if (values.empty()) return std::nan("");
  const auto k = static_cast<std::ptrdiff_t>(p * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return values[static_cast<std::size_t>(k)];
}

double median(std::vector<double> values) { return percentile(values, 0.5); }

nlohmann::ordered_json ratios(const std::vector<double>& times, const std::vector<double>& own,
                              double& spread) {
  std::vector<double> ratio;
  for (std::size_t turn = 0; turn < times.size(); ++turn) ratio.push_back(times[turn] / own[turn]);
  const double middle = median(ratio);
  const auto [least, most] = std::minmax_element(ratio.begin(), ratio.end());
  spread = std::max(spread, (*most - *least) / (2 * middle));
  return {{"ratio", significant(middle, 3)},
          {"ratio_least", significant(*least, 3)},
          {"ratio_most", significant(*most, 3)}};
}

double significant(double value, int digits) {
  return std::isfinite(value) ? std::stod(formatted("%.*g", digits, value)) : value;
}

std::string shown(double value) { return formatted("%g", value); }

void requirePlace(const std::filesystem::path& folder, const std::string& name) {
  if (name.empty() || name.find('/') != std::string::npos)
    throw Error("--name " + name + ": expected the name of a file without its folder, which -o names");
  if (folder.empty()) return;
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored))
    throw Error("-o " + folder.string() +
                (std::filesystem::exists(folder, ignored) ? ": is a file, expected a folder"
                                                          : ": this folder does not exist; make it first"));
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw Error("-o " + folder.string() + ": cannot be written to; name another folder");
}

void write(const Measurement& measurement, const std::string& command, const std::filesystem::path& folder) {
  std::string content = "{\n";
  const auto entry = [&](const char* key, const nlohmann::ordered_json& value) {
    content += nlohmann::ordered_json(key).dump() + ": " + value.dump() + ",\n";
  };
  entry("command", command);
  entry("machine", compiler() + " " FCL_STPBV_FLAGS ", one core of " + processor());
  entry("spread", significant(measurement.spread, 3));
  entry("about", measurement.about);
  content += "\"rows\": [";
  for (std::size_t i = 0; i < measurement.rows.size(); ++i)
    content += (i ? ",\n" : "\n") + measurement.rows[i].dump();
  content += "\n]\n}\n";
  const std::filesystem::path path = folder / (measurement.name + ".json");
  atomicWrite(path.string(), content);
  std::fprintf(stderr, "wrote %s\n", path.c_str());
}

}  // namespace fcl_stpbv::benchmark
