#include "tools/bench/chart.h"

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <stdexcept>

#include "tools/bench/timing.h"

namespace fcl_stpbv::benchmark {

namespace {

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

std::string quoted(const std::filesystem::path& path) {
  std::string result = "'";
  for (const char c : path.string()) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

void runGnuplot(const std::string& script) {
  FILE* gnuplot = popen("gnuplot", "w");
  if (!gnuplot) throw std::runtime_error("cannot start gnuplot");
  const bool sent = std::fwrite(script.data(), 1, script.size(), gnuplot) == script.size();
  if (pclose(gnuplot) != 0 || !sent) throw std::runtime_error("gnuplot failed; see its message above");
}

void writeText(const std::filesystem::path& path, const std::string& content) {
  std::ofstream file(path);
  file << content;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path.string());
}

std::string caption(const Chart& chart) {
  std::string result = chart.caption + "\\n" + machine();
  if (chart.spread > 0) result += text("; repeated blocks agree to %.0f %%", 100 * chart.spread);
  if (chart.spread > kQuietSpread) result += " (BUSY MACHINE)";
  return result;
}

std::string csv(const Chart& chart) {
  std::string result = "# " + caption(chart) + "\n" + chart.header + "\n";
  if (const auto line = result.find("\\n"); line != std::string::npos) result.replace(line, 2, "\n# ");
  for (const std::string& row : chart.rows) result += row + "\n";
  return result;
}

std::string script(const Chart& chart, const std::filesystem::path& svg) {
  return text("set terminal svg size %d,%d font 'Helvetica,12' background '#ffffff'\n", chart.width,
              chart.height) +
         "set encoding utf8\nset output " + quoted(svg) +
         "\nset grid lc rgb '#dddddd'\nset border 3 lc rgb '#888888'\nset tics nomirror\n"
         "set label 1 \"" +
         caption(chart) + "\" at screen 0.01,0.055 left font ',10' tc rgb '#555555' noenhanced\n" +
         chart.plot + "\n";
}

}  // namespace

std::string style(const std::string& method) {
  static const std::map<std::string, std::string> styles{
      {"FCL libccd", "lc rgb '#c44e52' pt 7"},          {"FCL indep", "lc rgb '#dd8452' pt 5"},
      {"Bullet GJK", "lc rgb '#8172b3' pt 9"},          {"FCL with gap stop", "lc rgb '#55a868' pt 11"},
      {"STP-BV through FCL", "lc rgb '#4fb3d9' pt 13"}, {"STP-BV warm", "lc rgb '#1f4e96' pt 7"}};
  const auto found = styles.find(method);
  return found == styles.end() ? "lc rgb '#555555' pt 6" : found->second;
}

std::string machine() {
#if defined(__clang__)
  const std::string compiler = text("clang++ %d.%d", __clang_major__, __clang_minor__);
#else
  const std::string compiler = text("g++ %d.%d", __GNUC__, __GNUC_MINOR__);
#endif
  return compiler + " " FCL_STPBV_FLAGS ", one core of " + processor();
}

std::string text(const char* format, ...) {
  char buffer[1024];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(buffer, sizeof buffer, format, arguments);
  va_end(arguments);
  return buffer;
}

void requireGnuplot() {
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0)
    throw std::runtime_error("the charts need gnuplot: install the Debian package gnuplot-nox");
}

bool write(const Chart& chart, const std::filesystem::path& folder, bool force) {
  std::filesystem::create_directories(folder);
  const std::filesystem::path svg = folder / (chart.name + ".svg"), table = folder / (chart.name + ".csv");
  if (chart.spread > kQuietSpread) {
    std::fprintf(stderr, "%s: the machine was busy, repeated blocks differ by %.0f %%\n", chart.name.c_str(),
                 100 * chart.spread);
    if (!force && (std::filesystem::exists(svg) || std::filesystem::exists(table))) {
      std::fprintf(stderr, "%s: kept the earlier files (--force replaces them)\n", chart.name.c_str());
      return false;
    }
  }
  // gnuplot first, into a file of another name: no chart without its picture, no half of one.
  const std::filesystem::path drawn = folder / (chart.name + ".part.svg");
  runGnuplot(script(chart, drawn));
  writeText(table, csv(chart));
  std::filesystem::rename(drawn, svg);
  std::fprintf(stderr, "wrote %s and %s\n", svg.c_str(), table.c_str());
  return true;
}

}  // namespace fcl_stpbv::benchmark
