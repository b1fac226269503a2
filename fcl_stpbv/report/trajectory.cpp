// See trajectory.h.
#include "fcl_stpbv/report/trajectory.h"

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/report/formatted.h"
#include "fcl_stpbv/robot/constraints.h"

namespace fcl_stpbv::report {
namespace {

using Eigen::VectorXd;

std::size_t segmentAt(const Trajectory& trajectory, double time) {
  const auto above = std::upper_bound(trajectory.time.begin() + 1, trajectory.time.end() - 1, time);
  return static_cast<std::size_t>(above - trajectory.time.begin()) - 1;
}

// The part of the trajectory's time that a part of a segment's way is at.
double timeAt(const Trajectory& trajectory, std::size_t segment, double part) {
  return trajectory.time[segment] + part * (trajectory.time[segment + 1] - trajectory.time[segment]);
}

void findContact(MotionCheck& check, double margin, TrajectoryReport& report) {
  const Trajectory& t = report.trajectory;
  report.verdict = MotionVerdict::free;
  report.from = report.until = t.time.back();
  for (std::size_t i = 0; i + 1 < t.points.size() && report.verdict == MotionVerdict::free; ++i) {
    const MotionBracket found = check.firstContact(t.points[i], t.points[i + 1], {margin, 1e-6});
    if (found.verdict == MotionVerdict::free) continue;
    report.verdict = found.verdict;
    report.from = timeAt(t, i, found.from);
    report.until = timeAt(t, i, found.until);
    report.pair = found.pair;
    report.contact = check.answer(found.pair, t.points[i] + found.until * (t.points[i + 1] - t.points[i]));
  }
}

void findClosest(MotionCheck& check, TrajectoryReport& report) {
  const Trajectory& t = report.trajectory;
  report.closestProven = true;
  for (std::size_t i = 0; i + 1 < t.points.size(); ++i) {
    const double precision = TrajectoryReport::kPrecision;
    // Times of a segment's part, to be told from those of the segments before.
    report.closestProven &=
        check.closest(t.points[i], t.points[i + 1], precision, static_cast<double>(i), report.closest);
  }
  for (Approach& approach : report.closest) {
    const double segment = std::min(std::floor(approach.time), static_cast<double>(t.points.size() - 2));
    approach.time = timeAt(t, static_cast<std::size_t>(segment), approach.time - segment);
  }
}

// Even times, and those that a chart must not miss however short they are: the closest approach, the contact.
std::vector<double> chartTimes(const TrajectoryReport& report) {
  constexpr int kChart = 400;
  const double begin = report.trajectory.time.front(), end = report.trajectory.time.back();
  std::vector<double> times{report.until};
  for (int k = 0; k <= kChart; ++k) times.push_back(begin + (end - begin) * k / kChart);
  const auto nearest =
      std::min_element(report.closest.begin(), report.closest.end(),
                       [](const Approach& a, const Approach& b) { return a.distance < b.distance; });
  times.push_back(nearest->time);
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

// Distances and their change at the times of the chart.
void sample(CollisionConstraints& rows, TrajectoryReport& report) {
  const Trajectory& t = report.trajectory;
  VectorXd d(rows.rows());
  auto jacobian = rows.makeJacobian();
  for (const double time : chartTimes(report)) {
    const std::size_t i = segmentAt(t, time);
    const VectorXd speed = (t.points[i + 1] - t.points[i]) / (t.time[i + 1] - t.time[i]);
    rows.evaluate(report.at(time), d, jacobian);
    const VectorXd change = jacobian * speed;
    Eigen::Index row;
    if (change.minCoeff(&row) < -report.steepest) {
      report.steepest = -change[row];
      report.steepestTime = time;
      report.steepestPair = static_cast<int>(row);
    }
    report.chartTime.push_back(time);
    report.chartDistance.push_back(d.minCoeff());
  }
}

}  // namespace

VectorXd TrajectoryReport::at(double time) const {
  const std::size_t i = segmentAt(trajectory, time);
  const double part = (time - trajectory.time[i]) / (trajectory.time[i + 1] - trajectory.time[i]);
  return trajectory.points[i] + part * (trajectory.points[i + 1] - trajectory.points[i]);
}

TrajectoryReport follow(Trajectory trajectory, std::shared_ptr<const Kinematics> kinematics,
                        std::shared_ptr<const RobotGeometry> geometry, const std::vector<CheckedPair>& pairs,
                        const std::vector<Obstacle>& obstacles, double margin) {
  TrajectoryReport report;
  report.trajectory = std::move(trajectory);
  MotionCheck check(kinematics, geometry, pairs, obstacles);
  findContact(check, margin, report);
  findClosest(check, report);
  ConstraintOptions options;
  options.obstacles = obstacles;
  CollisionConstraints rows(kinematics, geometry, pairs, options);
  sample(rows, report);
  return report;
}

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
  add("<text x=\"%.1f\" y=\"%.1f\">%g%s</text>", left, kHeight + 12, begin,
      report.trajectory.timed ? " s" : "");
  add("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%g%s</text>", kWidth, kHeight + 12, end,
      report.trajectory.timed ? " s" : "");
  svg += "<polyline fill=\"none\" stroke=\"#2a7ae2\" stroke-width=\"2\" points=\"";
  for (std::size_t i = 0; i < report.chartTime.size(); ++i)
    add("%.2f,%.2f ", x(report.chartTime[i]), y(report.chartDistance[i]));
  svg += "\"/>";
  if (report.verdict != MotionVerdict::free)
    add("<line x1=\"%.1f\" y1=\"10\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#c0392b\" stroke-width=\"2\"/>",
        x(report.until), x(report.until), y(low));
  return svg + "</svg>";
}

}  // namespace fcl_stpbv::report
