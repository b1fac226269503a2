// A chart: numbers as CSV, a picture as SVG by gnuplot, and whether the machine was quiet enough to believe
// it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fcl_stpbv::benchmark {

/// What a chart consists of; filled by the measurement, written by `write`.
struct Chart {
  std::string name;    ///< of both files, without extension
  std::string header;  ///< the CSV's first row
  std::vector<std::string> rows;
  std::string plot;     ///< gnuplot commands between "set output" and the end
  std::string caption;  ///< under the picture: what was asked how often, from which seed
  int width = 1000, height = 520;
  double spread = 0;  ///< widest disagreement of repeated blocks; 0 where nothing was timed
};

/// A curve's look in gnuplot: the same method has the same colour in every chart. The title may carry more.
std::string style(const std::string& method);

/// Compiler, flags and processor, as written under each chart.
std::string machine();

/// Text by printf's rules.
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
std::string
text(const char* format, ...);

/// @throws std::runtime_error where gnuplot is missing, before anything is measured in vain.
void requireGnuplot();

/// Writes both files. A chart of a busy machine never replaces an earlier one unless `force`: false then, and
/// a note on standard error.
/// @throws std::runtime_error where a file cannot be written or gnuplot fails.
bool write(const Chart& chart, const std::filesystem::path& folder, bool force);

}  // namespace fcl_stpbv::benchmark
