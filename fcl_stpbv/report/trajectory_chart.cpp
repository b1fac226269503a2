// The least distance over time as an SVG: its levels, its line, and a red one at the first contact.
#include <algorithm>
#include <cmath>

#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/report/trajectory.h"

namespace fcl_stpbv::report {

using detail::formatted;

std::string chartOf(const TrajectoryReport& report, double margin) {
  constexpr double kWidth = 1000, kHeight = 220, kBottom = 30;
  constexpr double kLetter = 9, kLine = 16;  // as wide and as high as text of 13 pixels is at most
  const double begin = report.chartTime.front(), end = report.chartTime.back();
  const auto [least, most] = std::minmax_element(report.chartDistance.begin(), report.chartDistance.end());
  const double low = std::min({0.0, margin, *least}), high = std::max({*most, margin, low + 1e-3});
  const auto label = [](double level) { return formatted("%.1f mm", level * 1e3); };
  const double left = 6 + kLetter * static_cast<double>(std::max(label(low).size(), label(high).size()));
  const auto x = [&](double time) { return left + (kWidth - left) * (time - begin) / (end - begin); };
  const auto y = [&](double d) { return (kHeight - kBottom) * (1 - (d - low) / (high - low)) + 10; };
  std::string svg;
  const auto add = [&svg](const char* pattern, auto... values) { svg += formatted(pattern, values...); };
  add("<svg viewBox=\"0 0 %g %g\" role=\"img\" aria-label=\"Least distance over time\" font-size=\"13\" "
      "fill=\"currentColor\">",
      kWidth + 20, kHeight + 20);
  std::vector<double> written;  // levels whose text no other one may lie over
  for (const double level : {margin, low, high}) {
    const auto over = [&](double other) { return std::abs(y(level) - y(other)) < kLine; };
    if (std::any_of(written.begin(), written.end(), over)) continue;
    written.push_back(level);
    add("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"currentColor\" opacity=\"0.3\"/>",
        left, y(level), kWidth, y(level));
    add("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%s</text>", left - 6, y(level) + 4,
        label(level).c_str());
  }
  add("<text x=\"%.1f\" y=\"%.1f\">%.12g%s</text>", left, kHeight + 12, begin,
      report.trajectory.timed ? " s" : "");
  add("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%.12g%s</text>", kWidth, kHeight + 12, end,
      report.trajectory.timed ? " s" : "");
  svg += "<polyline fill=\"none\" stroke=\"#2a7ae2\" stroke-width=\"2\" points=\"";
  for (std::size_t i = 0; i < report.chartTime.size(); ++i)
    add("%.2f,%.2f ", x(report.chartTime[i]), y(report.chartDistance[i]));
  svg += "\"/>";
  if (report.verdict != MotionVerdict::free)
    add("<line x1=\"%.1f\" y1=\"10\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#c0392b\" stroke-width=\"2\"/>",
        x(report.stop.until), x(report.stop.until), y(low));
  return svg + "</svg>";
}

}  // namespace fcl_stpbv::report
