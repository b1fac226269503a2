// Checks a robot along a trajectory: a proof that it is free, or the first contact; closest approaches and
// speeds.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/report/trajectory_file.h"
#include "fcl_stpbv/robot/motion_check.h"

namespace fcl_stpbv::report {

/// The end of the search for a contact. All pairs in the search are proven free before `from`.
struct TrajectoryStop {
  double from = 0, until = 0;  ///< of the trajectory's time
  int pair = -1;               ///< among the pairs of bodies; -1 where the trajectory is free
  DistanceAnswer answer;       ///< of the pair at `until`
};

struct TrajectoryReport {
  std::string path;
  Trajectory trajectory;
  MotionVerdict verdict = MotionVerdict::undecided;
  TrajectoryStop stop;  ///< the first contact; without one the first place where nothing is decided
  /// Pairs whose distance equals the margin up to rounding at some time, each with the start of that time, in
  /// order of time. The contact in `stop` is the first one of all other pairs.
  std::vector<TrajectoryStop> undecided;
  /// Time up to which the trajectory was checked. It is before the end if a proof needs too many distances;
  /// after it nothing is decided for any pair.
  double followedUntil = 0;
  /// Of each pair of bodies, whether it is proven free all the way, whatever becomes of the others.
  std::vector<bool> free;
  std::vector<Approach> closest;  ///< of each pair of bodies, its time that of the trajectory
  /// Every `closest` is that of the whole trajectory to this (m); false where
  /// a pair was too deep in another one.
  static constexpr double kPrecision = 1e-6;
  bool closestProven = false;
  double steepest = 0;  ///< fastest approach of any pair at the times of the chart (m a unit of time)
  double steepestTime = 0;
  int steepestPair = -1;
  /// Least distance of all pairs at 401 even times, where it is least of all, and at the contact.
  std::vector<double> chartTime, chartDistance;

  Eigen::VectorXd at(double time) const;
  /// A time to 1e-5 of the way to it and with its unit, rounded down where all before it was checked.
  std::string timeText(double time, bool down = false) const;
};

/// Straight lines through the way points. `pairs` are those of bodies to be
/// kept apart by more than `margin` (m).
TrajectoryReport follow(Trajectory trajectory, std::shared_ptr<const Kinematics> kinematics,
                        std::shared_ptr<const RobotGeometry> geometry, const std::vector<CheckedPair>& pairs,
                        const std::vector<Obstacle>& obstacles, double margin);

/// The least distance over time, with the margin and the first contact, as an SVG.
std::string chartOf(const TrajectoryReport& report, double margin);

}  // namespace fcl_stpbv::report
