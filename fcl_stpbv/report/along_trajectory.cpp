// Follows the pairs of bodies along a trajectory, reads off where each pair of links is closest, and places
// the pair there.
#include "fcl_stpbv/report/along_trajectory.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

// Where the bodies first to last of the trajectory's are closest on it, and whether they are free all the
// way: by a proof of their own, or because the closest approach is proven and above the margin by more than
// its precision. A contact may be less deep than that precision.
void placeOnTrajectory(const TrajectoryReport& trajectory, std::size_t first, std::size_t last, double margin,
                       PairReport& pair) {
  if (first == last) return;
  const auto isOwn = [&](const TrajectoryStop& stop) {
    return at(stop.pair) >= first && at(stop.pair) < last;
  };
  pair.stopsTrajectory = trajectory.verdict != MotionVerdict::free && isOwn(trajectory.stop);
  const bool touches = pair.stopsTrajectory && trajectory.verdict == MotionVerdict::contact;
  const auto from = static_cast<std::ptrdiff_t>(first), to = static_cast<std::ptrdiff_t>(last);
  const auto begin = trajectory.closest.begin();
  const auto nearest = std::min_element(
      begin + from, begin + to, [](const Approach& a, const Approach& b) { return a.distance < b.distance; });
  const bool isFarther = nearest->distance - TrajectoryReport::kPrecision > margin &&
                         trajectory.closestProven &&
                         trajectory.followedUntil >= trajectory.trajectory.time.back() &&
                         std::none_of(trajectory.undecided.begin(), trajectory.undecided.end(), isOwn);
  pair.freeAlong = isFarther || std::all_of(trajectory.free.begin() + from, trajectory.free.begin() + to,
                                            [](bool free) { return free; });
  const bool atStop = touches && !(nearest->distance < trajectory.stop.answer.distance);
  pair.time = atStop ? trajectory.stop.until : nearest->time;
  pair.configuration = atStop ? trajectory.stop.configuration
                              : trajectory.closestAt[static_cast<std::size_t>(nearest - begin)];
  pair.colliding = touches;
}

}  // namespace

void followPairs(const Trajectory& trajectory, const std::string& path, CollisionReport& report) {
  std::vector<CheckedPair> bodies;
  std::vector<std::size_t> first;  // of each pair's bodies
  report.trajectoryPairs.clear();
  for (const PairReport& pair : report.pairs) {
    first.push_back(bodies.size());
    if (!pair.checked) continue;
    const std::vector<CheckedPair> own = bodiesOf(*report.geometry, pair.links);
    bodies.insert(bodies.end(), own.begin(), own.end());
    report.trajectoryPairs.resize(bodies.size(), pair.links);
  }
  first.push_back(bodies.size());
  requirePairs(bodies.size(), *report.robot, countsOf(report.list));
  report.trajectory =
      follow(trajectory, report.kinematics, report.geometry, bodies, report.obstacles, report.margin);
  report.trajectory->path = path;
  for (std::size_t i = 0; i < report.pairs.size(); ++i) {
    report.pairs[i].configuration = trajectory.points.front();
    placeOnTrajectory(*report.trajectory, first[i], first[i + 1], report.margin, report.pairs[i]);
  }
}

std::string verdictAlong(const CollisionReport& report, const PairReport& pair) {
  if (!report.trajectory || !pair.checked) return "";
  if (pair.colliding) return toString(MotionVerdict::contact);
  return toString(pair.freeAlong ? MotionVerdict::free : MotionVerdict::undecided);
}

}  // namespace fcl_stpbv::report
