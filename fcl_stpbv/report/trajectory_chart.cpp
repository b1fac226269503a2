// The least distance over time as an SVG: axes with round ticks, the margin, the closest approach, and where
// the first contact is, or the first place at which nothing is decided.
#include <algorithm>
#include <cmath>

#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/report/trajectory.h"

namespace fcl_stpbv::report {

using detail::formatted;

namespace {

/// Ticks that divide a range of values into at most `most` parts: the step is 1, 2 or 5 times a power of ten.
struct Ticks {
  double step;
  int decimals = 0;

  Ticks(double range, int most) {
    const double least = range / most, power = std::pow(10.0, std::floor(std::log10(least)));
    const double factor = least <= power ? 1 : least <= 2 * power ? 2 : least <= 5 * power ? 5 : 10;
    step = factor * power;
    if (std::isfinite(step))
      decimals = std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 12);
  }
  template <typename Draw>
  void each(double from, double to, const Draw& draw) const {
    const double first = step * std::ceil(from / step - 1e-9);
    for (int i = 0; i < 20 && first + i * step <= to + 1e-9 * step; ++i) draw(first + i * step);
  }
  std::string label(double value) const { return detail::fixed(value, decimals); }
};

/// An SVG as it grows: lines and words in pixels.
class Drawing {
 public:
  std::string svg;

  template <typename... Values>
  void add(const char* pattern, Values... values) {
    svg += formatted(pattern, values...);
  }
  void line(double x1, double y1, double x2, double y2, const char* look) {
    add("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" %s/>", x1, y1, x2, y2, look);
  }
  void text(double x, double y, const char* look, const std::string& words) {
    add("<text x=\"%.1f\" y=\"%.1f\" %s>%s</text>", x, y, look, words.c_str());
  }
};

/// The chart of one trajectory; each part adds itself to the drawing.
class Chart : public Drawing {
 public:
  Chart(const TrajectoryReport& report, double margin)
      : report_(report),
        time_(report.chartTime),
        distance_(report.chartDistance),
        begin_(time_.front()),
        end_(time_.back()),
        margin_(margin),
        times_(end_ - begin_, 10) {
    const auto [least, most] = std::minmax_element(distance_.begin(), distance_.end());
    least_ = *least;
    nearest_ = time_[static_cast<std::size_t>(least - distance_.begin())];
    scale_ = *most >= 10 ? 1 : 1e3;
    unit_ = *most >= 10 ? "m" : "mm";
    const double lowest = scale_ * std::min({0.0, margin, *least}),
                 highest = scale_ * std::max({*most, margin, *least + 1e-6});
    levels_ = Ticks(highest - lowest, 5);
    low_ = levels_.step * std::floor(lowest / levels_.step + 1e-9);
    high_ = levels_.step * std::ceil(highest / levels_.step - 1e-9);
    const auto width = [&](double level) {
      return kLetter * static_cast<double>(levels_.label(level).size());
    };
    left_ = 34 + std::max(width(low_), width(high_));
  }

  void axes() {
    add("<svg viewBox=\"0 0 %g %g\" role=\"img\" aria-label=\"Least distance over time\" font-size=\"13\" "
        "fill=\"currentColor\" data-left=\"%g\" data-right=\"%g\">",
        kWidth, kHeight, left_, kRight);
    levels_.each(low_, high_, [&](double level) {
      const bool zero = std::abs(level) < 0.5 * levels_.step;
      line(left_, y(level), kRight, y(level), zero ? "stroke=\"currentColor\"" : kGrid);
      text(left_ - 7, y(level) + 4, "text-anchor=\"end\"", levels_.label(level));
    });
    times_.each(begin_, end_, [&](double at) {
      line(x(at), kTop, x(at), kBottom, kGrid);
      const std::string label = times_.label(at);
      const bool atEdge = x(at) + 0.5 * kLetter * static_cast<double>(label.size()) > kWidth;
      text(x(at), kBottom + 18, atEdge ? kEnd : kMiddle, label);
    });
    text(0.5 * (left_ + kRight), kHeight - 6, kMiddle, report_.trajectory.timed ? "time [s]" : "way point");
    add("<text transform=\"translate(14 %g) rotate(-90)\" text-anchor=\"middle\">least distance [%s]</text>",
        0.5 * (kTop + kBottom), unit_);
  }

  void marginLine() {
    if (margin_ == 0) return;
    const double level = y(scale_ * margin_);
    line(left_, level, kRight, level, "stroke=\"currentColor\" stroke-dasharray=\"2 4\"");
    const bool atLeft =
        x(nearest_) > 0.5 * (left_ + kRight);  // not over what is said of the closest approach
    text(atLeft ? left_ + 7 : kRight, level - 5, atLeft ? "" : kEnd,
         formatted("margin %g %s", scale_ * margin_, unit_));
  }

  void curve() {
    line(-9, kTop, -9, kBottom,
         "id=\"chosen\" stroke=\"#2a7ae2\" opacity=\"0.6\"");  // of a page, once it is asked for
    line(-9, kTop, -9, kBottom,
         "id=\"cursor\" stroke=\"currentColor\" opacity=\"0.6\"");  // where its mouse is
    svg += "<polyline fill=\"none\" stroke=\"#2a7ae2\" stroke-width=\"2\" points=\"";
    for (std::size_t i = 0; i < time_.size(); ++i) add("%.2f,%.2f ", x(time_[i]), y(scale_ * distance_[i]));
    svg += "\"/>";
    const double dot = y(scale_ * least_), below = dot + 20 < kBottom ? 18 : -8;
    add("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"#2a7ae2\"/>", x(nearest_), dot);
    const double shown = std::abs(least_) < 1e-9 ? 0 : scale_ * least_;
    text(x(nearest_), dot + below, beside(x(nearest_)),
         formatted("closest: %.4g %s", shown, unit_) + when(nearest_));
  }

  void verdict() {
    if (report_.verdict == MotionVerdict::free) return;
    const bool contact = report_.verdict == MotionVerdict::contact;
    const double at = x(contact ? report_.stop.until : report_.stop.from);
    const char* colour = contact ? "var(--hit, #c0392b)" : "var(--warn, #7a5200)";
    line(at, kTop - 12, at, kBottom,
         formatted("stroke=\"%s\" stroke-width=\"2\"%s", colour, contact ? "" : " stroke-dasharray=\"6 4\"")
             .c_str());
    text(at, kTop - 3, formatted("%s fill=\"%s\"", beside(at), colour).c_str(),
         contact ? "first contact" + when(report_.stop.until) : "not decided from here");
  }

 private:
  static constexpr double kWidth = 1200, kHeight = 270, kTop = 24, kBottom = 226, kRight = 1184;
  static constexpr double kLetter = 8,
                          kRoom = 300;  // as wide as a letter of 13 pixels and a label are at most
  static constexpr const char* kGrid = "stroke=\"currentColor\" opacity=\"0.15\"";
  static constexpr const char *kMiddle = "text-anchor=\"middle\"", *kEnd = "text-anchor=\"end\"";

  double x(double t) const { return left_ + (kRight - left_) * (t - begin_) / (end_ - begin_); }
  double y(double level) const { return kBottom - (kBottom - kTop) * (level - low_) / (high_ - low_); }
  std::string when(double t) const {
    return (report_.trajectory.timed ? " at " : " at way point ") + report_.timeText(t);
  }
  static const char* beside(double at) {
    return at > kRight - kRoom ? "text-anchor=\"end\" dx=\"-7\"" : "dx=\"7\"";
  }

  const TrajectoryReport& report_;
  const std::vector<double>&time_, &distance_;
  double begin_, end_, margin_;
  Ticks times_, levels_{1, 1};
  double least_ = 0, nearest_ = 0;  // the closest approach and its time
  double scale_ = 1;                // m or mm
  const char* unit_ = "m";
  double low_ = 0, high_ = 0, left_ = 0;
};

}  // namespace

std::string chartOf(const TrajectoryReport& report, double margin) {
  Chart chart(report, margin);
  chart.axes();
  chart.marginLine();
  chart.curve();
  chart.verdict();
  return chart.svg + "</svg>";
}

}  // namespace fcl_stpbv::report
