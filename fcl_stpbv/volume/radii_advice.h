// r and R for a body from what its user can spare, clearance and acceleration; and what the shapes of two
// bodies add to the second derivative of their distance.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <vector>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {

/// The radii of a body with corners and flat faces, for contactAcceleration().
constexpr Radii kFlatRadii{0, std::numeric_limits<double>::infinity(),
                           std::numeric_limits<double>::infinity()};

/// Bounds on the second derivative of the distance in time (m/s^2).
struct ContactAcceleration {
  double least;  ///< lower bound, not above 0
  double most;   ///< upper bound, not below 0

  /// The larger of both.
  double size() const { return std::max(most, -least); }  // in this order no -0
};

/// The distance d of two bodies has d'' = n . a + c. n is the normal, a the acceleration of body 2's material
/// point at its witness point, both as body 1 sees them; c is left over because the normal turns and the
/// witness points slide. These are bounds on c, derived in docs/choosing_r_and_R.md from the radii of
/// curvature of both surfaces, which lie in [r, R]. They hold while, as body 1 sees it,
/// - d is at least `distance` (m), which is above minus both r;
/// - body 2 moves across the normal with at most `speed` at its witness point (m/s);
/// - body 2 turns across the normal with at most `turning` (rad/s).
/// Infinite where nothing bounds it.
ContactAcceleration contactAcceleration(const Radii& body1, const Radii& body2, double distance, double speed,
                                        double turning);

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
/// volumes, up to a hundred for long periods. @throws Error for points without a volume, for
/// numbers that make no sense, and for a clearance that no radii keep.
RadiiAdvice adviseRadii(const std::vector<Eigen::Vector3d>& points, const RadiiTask& task);

}  // namespace fcl_stpbv
