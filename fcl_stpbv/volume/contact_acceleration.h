// What the shapes of two bodies add to the second derivative of their distance while they slide and turn.
#pragma once

#include <algorithm>
#include <limits>

#include "fcl_stpbv/volume/patch.h"

namespace fcl_stpbv {

/// The radii of a body with corners and flat faces, for contactAcceleration().
constexpr Radii kFlatRadii{0, std::numeric_limits<double>::infinity(),
                           std::numeric_limits<double>::infinity()};

/// Bounds (m/s^2).
struct ContactAcceleration {
  double least;  ///< not above 0: how fast the distance may bend down
  double most;   ///< not below 0: how fast it may bend up

  /// The larger of both.
  double size() const { return std::max(-least, most); }
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

}  // namespace fcl_stpbv
