// What a benchmark measured, as a JSON file. `tools/bench/draw` makes the charts and tables of the docs from
// these files, so measuring and drawing are apart.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fcl_stpbv::benchmark {

struct Measurement {
  std::string name;                                                 ///< of the file, without extension
  nlohmann::ordered_json about = nlohmann::ordered_json::object();  ///< what was asked, from which seed
  std::vector<nlohmann::ordered_json> rows;                         ///< objects with the same keys
  double spread = 0;  ///< widest disagreement of repeated blocks, relative; 0 where nothing was timed
};

/// The program's name and its arguments, but for the folder of the output.
std::string commandLine(int argc, char** argv);

/// Time this thread has run (ns): without the time that others had the core.
double threadTime();

/// Medians of `passes` passes over `count` queries of each way, the ways taking turns, so that what slows the
/// machine for a while slows all of them (ns a query, the thread's own time).
std::vector<double> mediansInTurns(int passes, std::size_t count,
                                   const std::vector<std::function<void(std::size_t)>>& ways);

/// The value below which a share `p` of the values lies; reorders them. NaN for none.
double percentile(std::vector<double>& values, double p);
double median(std::vector<double> values);

/// Rounds to so many significant digits: what a file shows of a measured value.
double significant(double value, int digits);

/// Few digits, as in "10" or "0.5".
std::string shown(double value);

/// Before the work: whether write() can write a file of this name into the folder, which is made if missing;
/// "" for none. @throws Error where it cannot, and where the name is none or names a folder too.
void requirePlace(const std::filesystem::path& folder, const std::string& name);

/// Writes `folder`/NAME.json whole or not at all, with the command, compiler, flags and processor.
/// @throws Error where the file cannot be written.
void write(const Measurement& measurement, const std::string& command, const std::filesystem::path& folder);

}  // namespace fcl_stpbv::benchmark
