// The results of a benchmark, as a JSON file. `tools/bench/draw` makes the charts and tables of the docs from
// these files, so measuring and drawing are separate.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/program.h"

namespace fcl_stpbv::benchmark {

struct Measurement {
  std::string name;  ///< name of the file, without extension
  /// The benchmark's parameters, such as its seed.
  nlohmann::ordered_json about = nlohmann::ordered_json::object();
  std::vector<nlohmann::ordered_json> rows;  ///< objects with the same keys
  double spread = 0;  ///< largest relative difference of repeated blocks; 0 if nothing was timed

  /// Keeps a row, and prints it at once as a line of JSON.
  void add(nlohmann::ordered_json row);
  /// Prints all rows as add() does.
  void print() const;
};

/// Runs a benchmark: adds -o and --name to its options, checks that NAME.json can be written, calls
/// `measure`, and writes the measurement that it has filled. Without -o nothing is written.
int runBenchmark(tools::Program& program, int argc, char** argv, const std::string& name,
                 const std::function<void(Measurement&)>& measure);

/// The program's name and its arguments, without the folder of the output.
std::string commandLine(int argc, char** argv);

/// Processor time of this thread (ns), without the time in which other processes had the core.
double threadTime();

/// The times of `passes` passes over `count` queries, for each way (ns per query, the thread's processor
/// time). The ways take turns, so that a temporary slowdown of the machine affects all of them.
std::vector<std::vector<double>> passesInTurns(int passes, std::size_t count,
                                               const std::vector<std::function<void(std::size_t)>>& ways);
/// Their medians.
std::vector<double> mediansInTurns(int passes, std::size_t count,
                                   const std::vector<std::function<void(std::size_t)>>& ways);

/// The value below which a share `p` of the values lies. Reorders the values. NaN if there are none.
double percentile(std::vector<double>& values, double p);
double median(std::vector<double> values);

/// Times as multiples of `own`, turn by turn: the entries "ratio" (their median), "ratio_least" and
/// "ratio_most". Enlarges `spread` to half of their relative range.
nlohmann::ordered_json ratios(const std::vector<double>& times, const std::vector<double>& own,
                              double& spread);

/// Rounds a measured value to this number of significant digits for a file.
double significant(double value, int digits);

/// The value with few digits, such as "10" or "0.5".
std::string shown(double value);

/// Call it before the work. Checks that write() can write a file of this name into the folder, which must
/// exist; "" for no folder. @throws Error if it cannot, or if the name is empty or
/// contains a folder.
void requirePlace(const std::filesystem::path& folder, const std::string& name);

/// Writes `folder`/NAME.json completely or not at all, with the command, compiler, flags and processor.
/// @throws Error if the file cannot be written.
void write(const Measurement& measurement, const std::string& command, const std::filesystem::path& folder);

}  // namespace fcl_stpbv::benchmark
