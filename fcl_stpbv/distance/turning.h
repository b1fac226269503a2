// How the normal between two features turns and their points slide as the bodies move: what Newton's method
// on the normal and second derivatives of the distance share (docs/theory.md, 6).
#pragma once

#include <Eigen/Core>

#include "fcl_stpbv/convex/shape_curvature.h"

namespace fcl_stpbv::detail {

/// Two features that face each other. With `apart`, the motion of the second one's point against the first
/// one's (m), and `carried`, what body 2 turns the normal against body 1 (rad), both in `frame`,
///
///     turning * apart - sliding^T * carried    is what the normal turns in body 2 besides (rad),
///     sliding * apart + rolling * carried      what body 1's point slides on it (m).
struct Turning {
  Eigen::Matrix<double, 3, 2> frame;  ///< two unit vectors across the normal
  Eigen::Matrix2d turning, sliding, rolling;

  /// The features' cones in one frame, and how far they are apart (m). False where nothing tells how the
  /// normal turns: between a face and a face or an edge, parallel edges, and where `rounding` (m) of the
  /// distance is all that is left of the radii of curvature.
  bool set(const NormalCone& a, const NormalCone& b, double distance, double rounding);
};

}  // namespace fcl_stpbv::detail
