// r and R for a body from what its user can spare: clearance and acceleration.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {

/// What a body is to do near others, and what may be spent on it. Its motion is that of its contacts, as the
/// other body sees it: contactAcceleration().
struct RadiiTask {
  double clearance = 0.005;  ///< most that may be lost of the space around the body (m)
  double acceleration = 1;   ///< most that the bodies' shapes may add to d'' (m/s^2)
  double speed = 0.3;        ///< of the body across the normal (m/s)
  double turning = 1;        ///< across the normal (rad/s)
  double period = 1e-3;      ///< of the controller; its rows are linear for that long (s)
  double distance = 0;       ///< that the volumes keep (m)
  /// Whether all that the body meets is rounded by the same task: margins add up, so each may be smaller.
  bool bothRound = false;
};

/// The radii and what they reach.
struct RadiiAdvice {
  StpBvOptions radii;  ///< r and R (m)
  /// Whether they keep both promises. Then r is the least that does. If not, r is the least for an
  /// acceleration a fifth above the least of all radii that keep the clearance. In both cases R is the
  /// smallest that the clearance takes.
  bool meetsBoth;
  double acceleration;    ///< most that the shapes add to d'' (m/s^2), whatever the other body is
  double overCover;       ///< of the volume of these radii (m)
  double perPeriod;       ///< how far d may fall below a linear row within a period (m)
  double leastClearance;  ///< that allows the stated acceleration (m); infinite where no volume does
};

/// For a body given by its points, from docs/choosing_r_and_R.md. Builds some thirty
/// volumes. @throws Error for points without a volume, for numbers that make no sense, and
/// for a clearance that no radii keep.
RadiiAdvice adviseRadii(const std::vector<Eigen::Vector3d>& points, const RadiiTask& task);

}  // namespace fcl_stpbv
