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
  double from = 0, until = 0;     ///< in the trajectory's time
  int pair = -1;                  ///< index among the pairs of bodies; -1 if the trajectory is free
  DistanceAnswer answer;          ///< distance of the pair at `until`
  Eigen::VectorXd configuration;  ///< at `until`
};

struct TrajectoryReport {
  std::string path;
  Trajectory trajectory;
  MotionVerdict verdict = MotionVerdict::undecided;
  TrajectoryStop stop;  ///< the first contact; if there is none, the first place where nothing is decided
  /// Pairs whose distance equals the margin up to rounding at some time, each with the start of that time, in
  /// order of time. The contact in `stop` is the first one of all other pairs.
  std::vector<TrajectoryStop> undecided;
  /// Time up to which the trajectory was checked. It is before the end if a proof needs too many distances;
  /// after it nothing is decided for any pair.
  double followedUntil = 0;
  /// For each pair of bodies, whether it is proven free all the way, whatever the result for the others.
  std::vector<bool> free;
  std::vector<Approach> closest;  ///< for each pair of bodies, with its time on the trajectory
  /// The configurations of `closest`. Their times may be too coarse, in a short segment late in a trajectory.
  std::vector<Eigen::VectorXd> closestAt;
  /// Precision (m) to which every `closest` is that of the whole trajectory if `closestProven` is true. It is
  /// false if a pair was too deep in another one.
  static constexpr double kPrecision = 1e-6;
  bool closestProven = false;
  double steepest = 0;  ///< fastest approach of any pair at the times of the chart (m per unit of time)
  double steepestTime = 0;
  int steepestPair = -1;
  /// Least distance of all pairs at 401 even times, where it is least of all, and at the contact; and of
  /// which pair it is.
  std::vector<double> chartTime, chartDistance;
  std::vector<int> chartPair;

  Eigen::VectorXd at(double time) const;
  /// Where a time is between the first and the last way point: from 0 to 1.
  double share(double time) const;
  /// A time with its unit, rounded down where all before it was checked. All times of a trajectory have the
  /// same decimals: three, more for one that is shorter than a second.
  std::string timeText(double time, bool down = false) const;
};

/// Follows straight lines through the way points. `pairs` are the pairs of bodies that must be more than
/// `margin` (m) apart.
TrajectoryReport follow(Trajectory trajectory, std::shared_ptr<const Kinematics> kinematics,
                        std::shared_ptr<const RobotGeometry> geometry, const std::vector<CheckedPair>& pairs,
                        const std::vector<Obstacle>& obstacles, double margin);

/// The least distance over time, with the margin and the first contact, as an SVG.
std::string chartOf(const TrajectoryReport& report, double margin);

}  // namespace fcl_stpbv::report
