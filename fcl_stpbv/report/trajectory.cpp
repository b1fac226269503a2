// Checks a robot along a trajectory, segment by segment:
// 1. The first contact: bracketed in time, or proven absent (robot/motion_check.h).
// 2. Each pair's closest approach, proven likewise.
// 3. If it is not free for all pairs: the pairs for which it is free.
// 4. Even samples, the contact and the closest approach, for the chart and the steepest approach: distances
//    and, by the Jacobian, how fast they change.
#include "fcl_stpbv/report/trajectory.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/robot/constraints.h"

namespace fcl_stpbv::report {
namespace {

using Eigen::VectorXd;

std::size_t segmentAt(const Trajectory& trajectory, double time) {
  const auto above = std::upper_bound(trajectory.time.begin() + 1, trajectory.time.end() - 1, time);
  return static_cast<std::size_t>(above - trajectory.time.begin()) - 1;
}

// The trajectory's time at a share `part` of a segment's way.
double timeAt(const Trajectory& trajectory, std::size_t segment, double part) {
  return trajectory.time[segment] + part * (trajectory.time[segment + 1] - trajectory.time[segment]);
}

/// The configuration at a share of the way from way point `i` to the next one.
VectorXd pointOf(const Trajectory& t, std::size_t i, double part) {
  return t.points[i] + part * (t.points[i + 1] - t.points[i]);
}

/// A trajectory's first contact, or the first place where nothing is decided.
struct FirstStop {
  MotionVerdict verdict = MotionVerdict::free;
  std::size_t segment = 0;
  TrajectoryStop at;
  bool tooLong = false;
};

FirstStop firstStop(MotionCheck& check, double margin, const Trajectory& t, std::size_t segment) {
  for (std::size_t i = segment; i + 1 < t.points.size(); ++i) {
    const MotionRequest request{margin, 1e-6};
    const MotionBracket found = check.firstContact(t.points[i], t.points[i + 1], request);
    if (found.verdict == MotionVerdict::free) continue;
    const VectorXd q = pointOf(t, i, found.until);
    return {found.verdict,
            i,
            {timeAt(t, i, found.from), timeAt(t, i, found.until), found.pair, check.answer(found.pair, q), q},
            found.tooMany};
  }
  FirstStop none;
  none.at.from = none.at.until = t.time.back();
  return none;
}

/// The robot that is followed, and the pairs of bodies for which the search goes on.
struct Followed {
  std::shared_ptr<const Kinematics> kinematics;
  std::shared_ptr<const RobotGeometry> geometry;
  const std::vector<Obstacle>& obstacles;
  double margin;
  std::vector<CheckedPair> pairs;  // the pairs that are left
  std::vector<int> number;         // index of each of them among all pairs
  std::size_t segment = 0;         // the pairs are free before this segment

  void markFree(TrajectoryReport& report) const {
    for (const int pair : number) report.free[static_cast<std::size_t>(pair)] = true;
  }
  void setAside(std::ptrdiff_t pair) {
    number.erase(number.begin() + pair);
    pairs.erase(pairs.begin() + pair);
  }
  FirstStop next(const Trajectory& trajectory) {
    MotionCheck check(kinematics, geometry, pairs, obstacles);
    return next(check, trajectory);
  }
  FirstStop next(MotionCheck& check, const Trajectory& trajectory) {
    const FirstStop stop = firstStop(check, margin, trajectory, segment);
    segment = stop.segment;
    return stop;
  }
};

// A pair whose distance equals the margin up to rounding must not hide a contact of another pair. So it is
// set aside, and the search goes on with the others from where it was. @return whether all pairs that are
// left are free.
bool findContact(MotionCheck& all, Followed& left, TrajectoryReport& report) {
  FirstStop stop = left.next(all, report.trajectory);
  while (stop.verdict == MotionVerdict::undecided && !stop.tooLong) {
    const std::ptrdiff_t pair = stop.at.pair;
    stop.at.pair = left.number[static_cast<std::size_t>(pair)];
    report.undecided.push_back(stop.at);
    left.setAside(pair);
    if (left.pairs.empty()) break;
    stop = left.next(report.trajectory);
  }
  report.followedUntil = stop.tooLong ? stop.at.from : report.trajectory.time.back();
  if (stop.verdict != MotionVerdict::contact && !report.undecided.empty()) {
    report.verdict = MotionVerdict::undecided;
    report.stop = report.undecided.front();
  } else {
    report.verdict = stop.verdict;
    report.stop = stop.at;
    if (stop.at.pair >= 0) report.stop.pair = left.number[static_cast<std::size_t>(stop.at.pair)];
  }
  return stop.verdict == MotionVerdict::free;
}

// Finds which of the pairs that are left are free all the way, each by a proof of its own. The search goes on
// without those that touch or have no distance, which are found by their closest approaches or by the search
// itself. It also goes on without a few that take too many distances.
void findFree(Followed left, TrajectoryReport& report) {
  for (auto i = static_cast<std::ptrdiff_t>(left.number.size()) - 1; i >= 0; --i) {
    const auto pair = static_cast<std::size_t>(left.number[static_cast<std::size_t>(i)]);
    if (!(report.closest[pair].distance > left.margin)) left.setAside(i);
  }
  constexpr int kMostLong = 5;  // each takes some tenths of a second
  for (int tooLong = 0; !left.pairs.empty() && tooLong <= kMostLong;) {
    const FirstStop stop = left.next(report.trajectory);
    if (stop.verdict == MotionVerdict::free) return left.markFree(report);
    tooLong += stop.tooLong;
    left.setAside(stop.at.pair);
  }
}

void findClosest(MotionCheck& check, TrajectoryReport& report) {
  const Trajectory& t = report.trajectory;
  report.closestProven = true;
  for (std::size_t i = 0; i + 1 < t.points.size(); ++i) {
    const double precision = TrajectoryReport::kPrecision;
    // The number of the segment is added to the share of its way, so that the segments can be told apart.
    report.closestProven &=
        check.closest(t.points[i], t.points[i + 1], precision, static_cast<double>(i), report.closest);
  }
  for (Approach& approach : report.closest) {
    const double segment = std::min(std::floor(approach.time), static_cast<double>(t.points.size() - 2));
    const double part = approach.time - segment;
    const auto i = static_cast<std::size_t>(segment);
    approach.time = timeAt(t, i, part);
    report.closestAt.push_back(pointOf(t, i, part));
  }
}

// Evenly spaced times, and those that a chart must not miss, however short the events are: the closest
// approach, the contact.
std::vector<double> chartTimes(const TrajectoryReport& report) {
  constexpr int kChart = 400;
  const double begin = report.trajectory.time.front(), end = report.trajectory.time.back();
  std::vector<double> times{report.stop.until};
  for (int k = 0; k <= kChart; ++k) times.push_back(begin + (end - begin) * k / kChart);
  const auto nearest =
      std::min_element(report.closest.begin(), report.closest.end(),
                       [](const Approach& a, const Approach& b) { return a.distance < b.distance; });
  times.push_back(nearest->time);
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

// Computes distances and their rates of change at the times of the chart.
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
    Eigen::Index nearest;
    report.chartDistance.push_back(d.minCoeff(&nearest));
    report.chartPair.push_back(static_cast<int>(nearest));
  }
}

}  // namespace

VectorXd TrajectoryReport::at(double time) const {
  const std::size_t i = segmentAt(trajectory, time);
  const double part = (time - trajectory.time[i]) / (trajectory.time[i + 1] - trajectory.time[i]);
  return pointOf(trajectory, i, part);
}

double TrajectoryReport::share(double time) const {
  return (time - trajectory.time.front()) / (trajectory.time.back() - trajectory.time.front());
}

std::string TrajectoryReport::timeText(double time, bool down) const {
  const double way = trajectory.time.back() - trajectory.time.front();
  const int decimals = std::clamp(static_cast<int>(std::ceil(3 - std::log10(way))), 3, 12);
  const double unit = std::pow(10.0, -decimals);
  return detail::fixed(down ? unit * std::floor(time / unit) : time, decimals) +
         (trajectory.timed ? " s" : "");
}

TrajectoryReport follow(Trajectory trajectory, std::shared_ptr<const Kinematics> kinematics,
                        std::shared_ptr<const RobotGeometry> geometry, const std::vector<CheckedPair>& pairs,
                        const std::vector<Obstacle>& obstacles, double margin) {
  TrajectoryReport report;
  report.trajectory = std::move(trajectory);
  report.free.assign(pairs.size(), false);
  Followed left{kinematics, geometry, obstacles, margin, pairs, std::vector<int>(pairs.size())};
  std::iota(left.number.begin(), left.number.end(), 0);
  MotionCheck check(kinematics, geometry, pairs, obstacles);
  const bool allLeft = findContact(check, left, report);
  findClosest(check, report);
  if (allLeft)
    left.markFree(report);
  else
    findFree(std::move(left), report);
  ConstraintOptions options;
  options.obstacles = obstacles;
  CollisionConstraints rows(kinematics, geometry, pairs, options);
  sample(rows, report);
  return report;
}

}  // namespace fcl_stpbv::report
