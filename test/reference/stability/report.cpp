// The suite's results as tables and as a picture.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "test/reference/stability/suite.h"

namespace fcl_stpbv::stability {

namespace {

std::vector<std::string> groupsOf(const Results& results) {
  std::vector<std::string> groups;
  for (const Situation& s : results.situations)
    if (std::find(groups.begin(), groups.end(), s.group) == groups.end()) groups.push_back(s.group);
  return groups;
}

bool worse(const Judgement& x, const Judgement& y) {
  return x.verdict != y.verdict ? x.verdict > y.verdict : x.amount > y.amount;
}

/// "3: wrong by 2e-04": how many of the group's cases failed, and the worst.
std::string cell(const Results& results, std::size_t method, const std::string& group) {
  Judgement worst;
  int failed = 0, deepLocal = 0, deepGlobal = 0, rough = 0;
  for (std::size_t i = 0; i < results.situations.size(); ++i) {
    if (results.situations[i].group != group) continue;
    const Judgement& j = results.of[method][i];
    if (worse(j, worst)) worst = j;
    failed += isFailure(j.verdict);
    deepLocal += j.verdict == Verdict::local;
    deepGlobal += j.verdict == Verdict::global;
    rough += j.verdict == Verdict::tolerance;
  }
  if (failed) return std::to_string(failed) + ": " + worst.text();
  if (rough) return std::to_string(rough) + " within tolerance";
  if (deepLocal + deepGlobal)
    return std::to_string(deepGlobal) + " global, " + std::to_string(deepLocal) + " local";
  return "exact";
}

/// How dark a case is in the picture: 0 exact, 1 within tolerance, 2 to 5 wrong or a jump by its size, 6
/// worse.
int shade(const Judgement& j) {
  switch (j.verdict) {
    case Verdict::exact:
    case Verdict::global:
      return 0;
    case Verdict::local:
    case Verdict::tolerance:
      return 1;
    case Verdict::jump:
      return 2;
    case Verdict::wrong:
      return j.amount < 1e-5 ? 3 : j.amount < 1e-3 ? 4 : 5;
    case Verdict::none:
      return 6;
    case Verdict::nan:
    case Verdict::exception:
      return 7;
    case Verdict::hang:
    case Verdict::abort:
      return 8;
  }
  return 8;
}

}  // namespace

std::string markdown(const Results& results) {
  std::string text = "| " + std::to_string(results.situations.size()) + " cases |";
  for (const Method& m : results.methods) text += " " + m.title + " |";
  text += "\n|---|";
  for (std::size_t m = 0; m < results.methods.size(); ++m) text += "---|";
  text += "\n";
  for (int v = 0; v < kVerdicts; ++v) {
    text += std::string("| ") + nameOf(static_cast<Verdict>(v)) + " |";
    for (const auto& judged : results.of)
      text += " " +
              std::to_string(
                  std::count_if(judged.begin(), judged.end(),
                                [&](const Judgement& j) { return j.verdict == static_cast<Verdict>(v); })) +
              " |";
    text += "\n";
  }
  text += "| **failures** |";
  const nlohmann::ordered_json totals = summary(results);
  for (const Method& m : results.methods)
    text += " **" + std::to_string(totals["failures"][m.id].get<int>()) + "** |";
  text += "\n\n| group (cases) |";
  for (const Method& m : results.methods) text += " " + m.title + " |";
  text += "\n|---|";
  for (std::size_t m = 0; m < results.methods.size(); ++m) text += "---|";
  text += "\n";
  for (const std::string& group : groupsOf(results)) {
    const auto cases = std::count_if(results.situations.begin(), results.situations.end(),
                                     [&](const Situation& s) { return s.group == group; });
    text += "| " + group + " (" + std::to_string(cases) + ") |";
    for (std::size_t m = 0; m < results.methods.size(); ++m) text += " " + cell(results, m, group) + " |";
    text += "\n";
  }
  return text;
}

std::string csv(const Results& results) {
  std::string text = "group,case,placements";
  for (const Method& m : results.methods) text += "," + m.id;
  text += "\n";
  const auto quoted = [](const std::string& s) { return "\"" + s + "\""; };
  for (std::size_t i = 0; i < results.situations.size(); ++i) {
    const Situation& s = results.situations[i];
    text += quoted(s.group) + "," + quoted(s.name) + "," + std::to_string(s.placements.size());
    for (const auto& judged : results.of) text += "," + judged[i].text();
    text += "\n";
  }
  return text;
}

std::string strip(const Results& results, const std::string& svg) {
  const std::size_t rows = results.methods.size(), columns = results.situations.size();
  std::string data = "$shade << EOD\n";
  for (std::size_t m = 0; m < rows; ++m) {
    for (std::size_t i = 0; i < columns; ++i) data += std::to_string(shade(results.of[m][i])) + " ";
    data += "\n";
  }
  data += "EOD\n";
  std::string ticks, lines;
  for (std::size_t m = 0; m < rows; ++m)
    ticks += (m ? ", " : "") + ("\"" + results.methods[m].title + "\" ") + std::to_string(m);
  std::string names;
  std::size_t first = 0;
  for (std::size_t i = 1; i <= columns; ++i) {
    if (i < columns && results.situations[i].group == results.situations[first].group) continue;
    char tick[128];
    std::snprintf(tick, sizeof tick, "%s\"%s\" %.1f", names.empty() ? "" : ", ",
                  results.situations[first].group.c_str(), 0.5 * static_cast<double>(first + i) - 0.5);
    names += tick;
    if (i < columns) {
      char line[128];
      std::snprintf(
          line, sizeof line, "set arrow from %.1f,-0.5 to %.1f,%.1f nohead front lc rgb '#ffffff' lw 1\n",
          static_cast<double>(i) - 0.5, static_cast<double>(i) - 0.5, static_cast<double>(rows) - 0.5);
      lines += line;
    }
    first = i;
  }
  char size[160];
  std::snprintf(size, sizeof size, "set terminal svg size 1200,%d font 'Helvetica,12' background '#ffffff'\n",
                static_cast<int>(260 + 22 * rows));
  return size + ("set output '" + svg + "'\n") + data + lines +
         "set palette defined (0 '#d9e8d4', 1 '#a9c9e8', 2 '#f3dc8f', 3 '#f0b467', 4 '#e58a4d', 5 '#c44e52', "
         "6 '#b8a4d4', 7 '#7d5ba6', 8 '#222222') maxcolors 9\n"
         "set cbrange [-0.5:8.5]\nset cbtics ('exact' 0, 'within tolerance' 1, 'gradient jumps' 2, 'wrong < "
         "10 um' 3, "
         "'wrong < 1 mm' 4, 'wrong by more' 5, 'no answer' 6, 'NaN, exception' 7, 'hang, abort' 8) scale 0\n"
         "set xrange [-0.5:" +
         std::to_string(columns) + "-0.5]\nset yrange [" + std::to_string(rows) + "-0.5:-0.5]\nset ytics (" +
         ticks + ") scale 0\nset xtics (" + names +
         ") rotate by -55 left font ',9' scale 0\nset border lc rgb '#888888'\n"
         "set colorbox user origin 0.885,0.45 size 0.012,0.5\nset lmargin at screen 0.2\nset rmargin at "
         "screen 0.87\n"
         "set tmargin at screen 0.97\nset bmargin at screen 0.4\n"
         "plot $shade matrix with image pixels notitle\n";
}

}  // namespace fcl_stpbv::stability
