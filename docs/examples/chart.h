// Draws curves over time on a logarithmic scale, as an SVG for the page that an example writes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

struct Curve {
  const char *name, *colour;
  std::vector<double> values;  // at equal time steps
};

/// A dashed line across; without a name there is none.
struct Level {
  const char* name = nullptr;
  double value = 1;
};

/// From 0 to `seconds` across and from 10^low to 10^high upwards; what lies beyond is drawn on the edge.
inline std::string chart(int seconds, int low, int high, const std::vector<Curve>& curves, Level level = {}) {
  constexpr double kLeft = 56, kRight = 790, kTop = 30, kBottom = 234;
  const auto x = [&](double time) { return kLeft + (kRight - kLeft) * time / seconds; };
  const auto y = [&](double exponent) {
    return kBottom - (kBottom - kTop) * (std::clamp<double>(exponent, low, high) - low) / (high - low);
  };
  std::string svg = "<svg viewBox='0 0 800 276'>";
  const auto add = [&svg](const char* pattern, auto... values) {
    char text[300];
    std::snprintf(text, sizeof text, pattern, values...);
    svg += text;
  };
  for (int i = low; i <= high; ++i)
    add("<path d='M%g %gH%g' stroke='currentColor' opacity='.15'/><text x='%g' y='%g' "
        "text-anchor='end'>%g</text>",
        kLeft, y(i), kRight, kLeft - 6, y(i) + 5, std::pow(10, i));
  for (int time = 0; time <= seconds; ++time)
    add("<path d='M%g %gV%g' stroke='currentColor' opacity='.15'/><text x='%g' y='%g' "
        "text-anchor='middle'>%d</text>",
        x(time), kTop, kBottom, x(time), kBottom + 18, time);
  add("<text x='%g' y='%g' text-anchor='middle'>time (s)</text>", x(0.5 * seconds), kBottom + 38);
  if (level.name) {
    const double at = y(std::log10(level.value));
    add("<path d='M%g %gH%g' stroke='currentColor' stroke-dasharray='6 4'/><text x='%g' y='%g'>%s</text>",
        kLeft, at, kRight, kLeft + 6, at - 6, level.name);
  }
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const Curve& curve = curves[c];
    const double name = kLeft + 240 * static_cast<double>(c);
    add("<path d='M%g 12h24' stroke='%s' stroke-width='3'/><text x='%g' y='17'>%s</text>", name, curve.colour,
        name + 30, curve.name);
    add("<polyline fill='none' stroke='%s' stroke-width='1.5' points='", curve.colour);
    for (std::size_t i = 0; i < curve.values.size(); ++i)
      add("%.1f,%.1f ", x(seconds * static_cast<double>(i) / static_cast<double>(curve.values.size())),
          y(std::log10(curve.values[i])));
    svg += "'/>";
  }
  return svg + "</svg>";
}
