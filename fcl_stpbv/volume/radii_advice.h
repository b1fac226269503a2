// Chooses r and R for a body from two budgets of the user: clearance and acceleration. Also bounds how much
// the shapes of two bodies add to the second derivative of their distance.
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

/// Bounds on the shapes' part of the second derivative of the distance with respect to time (m/s^2).
struct ContactAcceleration {
  double least;  ///< lower bound, not above 0
  double most;   ///< upper bound, not below 0

  /// The larger of `most` and `-least`.
  double size() const { return std::max(most, -least); }  // this order of the arguments avoids -0
};

/// The distance d of two bodies has the second time derivative d'' = n . a + c. Here n is the normal, and a
/// is the acceleration of the point that is fixed to body 2 and now at its witness point, both in the frame
/// of body 1. The term c exists because the normal turns and the witness points slide. This function bounds
/// c. docs/choosing_r_and_R.md derives the bounds from the radii of curvature of both surfaces, which lie in
/// [r, R]. They hold while, in the frame of body 1,
/// - d is at least `distance` (m), which must be above -(r1 + r2);
/// - the velocity of body 2 at its witness point, perpendicular to the normal, is at most `speed` (m/s);
/// - the angular velocity of body 2, perpendicular to the normal, is at most `turning` (rad/s).
///
/// A bound is infinite if c is unbounded. For a `distance` of -(r1 + r2) or less, `most` is infinite if
/// body 2 moves, except at -(r1 + r2) if it only turns and r2 = 0.
ContactAcceleration contactAcceleration(const Radii& body1, const Radii& body2, double distance, double speed,
                                        double turning);

/// How a body moves near others, and the two budgets. The velocities are relative to the other body, as in
/// contactAcceleration().
struct RadiiTask {
  /// Largest loss of free space around the body: over-cover plus `perPeriod` of the result (m).
  double clearance = 0.005;
  double acceleration = 1;  ///< largest amount that the bodies' shapes may add to d'' (m/s^2)
  double speed = 0.3;       ///< speed of the body's contact point, perpendicular to the normal (m/s)
  double turning = 1;       ///< angular velocity perpendicular to the normal (rad/s)
  double period = 1e-3;     ///< period of the controller, in which its constraints stay linear (s)
  double distance = 0;      ///< distance that the volumes keep (m)
  /// Whether all other bodies are STP-BVs made for the same task. The margins of both add up, so each may be
  /// smaller.
  bool bothRound = false;
};

/// The radii and their effect.
struct RadiiAdvice {
  StpBvOptions radii;  ///< r and R (m)
  /// Whether the radii keep both budgets, clearance and acceleration. If they do, r is the smallest one that
  /// does. If not, r is the smallest one for an acceleration that is a fifth above the lowest acceleration
  /// possible within the clearance. In both cases R is the smallest one that the clearance allows.
  bool meetsBoth;
  double acceleration;  ///< upper bound on what the shapes add to d'', for any other body (m/s^2)
  double overCover;     ///< over-cover of the volume with these radii (m)
  double perPeriod;     ///< how far d may fall below a linearised constraint within one period (m)
  /// Smallest clearance that the task's acceleration needs (m); infinite if no volume does.
  double leastClearance;
};

/// Radii for the body around these points (m), by the method of docs/choosing_r_and_R.md. Builds about
/// fifteen volumes, up to a hundred where the clearance is too small for the task. @throws Error for points
/// that have no volume, for numbers out of range, and for a clearance that no radii can keep.
RadiiAdvice adviseRadii(const std::vector<Eigen::Vector3d>& points, const RadiiTask& task);

}  // namespace fcl_stpbv
