// How the normal between two features turns, and how their points slide, when the bodies move. Newton's
// method on the normal and the second derivatives of the distance both use this (docs/theory.md, 6).
#pragma once

#include <Eigen/Core>

#include "fcl_stpbv/convex/shape_curvature.h"

namespace fcl_stpbv::detail {

/// Two features that face each other. The inputs are, both in `frame`: `apart`, the motion of the second
/// feature's point relative to the first one's (m), and `carried`, the rotation of the normal that body 2
/// causes relative to body 1 (rad). The results are
///
///     turning * apart - sliding^T * carried    the turn of the normal relative to body 2 (rad),
///     sliding * apart + rolling * carried      how far body 1's point slides on body 1 (m).
struct Turning {
  Eigen::Matrix<double, 3, 2> frame;  ///< two unit vectors across the normal
  Eigen::Matrix2d turning, sliding, rolling;

  /// The features' cones in one frame, and how far they are apart (m). False if the turn of the normal is
  /// undetermined: between a face and a face or an edge, for parallel edges, and if the sum of the radii of
  /// curvature is only `rounding` (m).
  bool set(const NormalCone& a, const NormalCone& b, double distance, double rounding);
};

}  // namespace fcl_stpbv::detail
