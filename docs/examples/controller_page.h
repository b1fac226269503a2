// What the controller's example writes: a table and a page with its curves.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <vector>

#include "docs/examples/chart.h"
#include "docs/examples/page_head.h"
#include "fcl_stpbv/error.h"

struct Tick {
  double distance;      ///< of the boxes beyond their margins (m)
  double acceleration;  ///< the largest of a joint (rad/s^2)
};

class ControllerPage {
 public:
  /// Opens both files before the work, so that a missing folder is reported at once.
  explicit ControllerPage(const std::filesystem::path& folder)
      : csv_(opened(folder / "controller.csv")), page_(opened(folder / "controller.html")) {}

  /// Returns whether the STP-BVs' peak is ten times below that of the boxes, and the distance was kept.
  bool write(const std::vector<Tick>& smooth, const std::vector<Tick>& flat, double period) {
    csv_ << "seconds,distance,distance_boxes,acceleration,acceleration_boxes\n";
    double peak = 0, peakFlat = 0, least = 1;
    for (std::size_t i = 0; i < smooth.size(); ++i) {
      const double time = static_cast<double>(i) * period;
      csv_ << time << ',' << smooth[i].distance << ',' << flat[i].distance << ',' << smooth[i].acceleration
           << ',' << flat[i].acceleration << '\n';
      if (time < 0.5) continue;  // leave out the start from rest
      peak = std::max(peak, smooth[i].acceleration);
      peakFlat = std::max(peakFlat, flat[i].acceleration);
      least = std::min(least, smooth[i].distance);
    }
    char found[200];
    std::snprintf(found, sizeof found,
                  "On STP-BVs the joints reach %.1f rad/s², on boxes with a margin %.0f rad/s²", peak,
                  peakFlat);
    page_ << pageHead(found)
          << "<p>Two arms move the boxes they hold past each other, kept apart by a velocity damper. The "
             "peaks are those after 0.5 s: before, the arms start from rest.</p>";
    const auto picture = [&](const char* title, double Tick::*value, double unit, int low, int high,
                             Level level) {
      Curve boxes{"the boxes with a margin", "var(--hulls)", {}},
          volumes{"their STP-BVs", "var(--smooth)", {}};
      for (const Tick& tick : flat) boxes.values.push_back(tick.*value / unit);
      for (const Tick& tick : smooth) volumes.values.push_back(tick.*value / unit);
      const int seconds = static_cast<int>(std::lround(static_cast<double>(smooth.size()) * period));
      page_ << "\n<h2>" << title << "</h2>\n<div class='chart'>"
            << chart(seconds, low, high, {boxes, volumes}, level) << "</div>\n";
    };
    picture("Largest joint acceleration (rad/s²)", &Tick::acceleration, 1, -1, 3, {});
    picture("Distance beyond the margins (mm)", &Tick::distance, 1e-3, 0, 3, {"10 mm, to be kept", 10});
    page_ << "</html>\n";
    std::printf("peak acceleration %.3g rad/s^2 on STP-BVs, %.3g on boxes; %.4f m kept\n", peak, peakFlat,
                least);
    if (!csv_.flush() || !page_.flush())
      throw fcl_stpbv::Error("controller.csv or controller.html could not be written");
    return peakFlat > 10 * peak && least > 0.0099;
  }

 private:
  static std::ofstream opened(const std::filesystem::path& path) {
    std::ofstream file(path);
    if (!file) throw fcl_stpbv::Error(path.string() + ": cannot be written; name a folder that is there");
    return file;
  }

  std::ofstream csv_, page_;
};
