// r and R that fit a body's size, so that a thin finger does not get a margin of a centimetre.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv::detail {

/// What of a body's size the radii follow (m).
struct BodySize {
  double width =
      0;            ///< smallest distance of two parallel planes with the body between them, or a little less
  double ball = 0;  ///< radius of the smallest ball around the body
};

/// Of a cloud's convex hull. The width is within 1e-6 of itself below the truth for hulls of up to some
/// hundred vertices; for finer round ones as far as the expanding polytope got. @throws Error for a cloud
/// that is empty or not finite.
BodySize sizeOf(const std::vector<Eigen::Vector3d>& points);

/// r is a twentieth of the width, but at most 1 cm, the paper's value, and at least 1/250 of the ball's
/// radius, without which a flat body had none. R is fittedR().
StpBvOptions fittedRadii(const BodySize& size);

/// The R with which the surface bulges by at most r, or by 1/200 of the ball's radius where that is more,
/// beyond r: the excess over the hull is at most r plus that (docs/choosing_r_and_R.md).
double fittedR(double ball, double r);

}  // namespace fcl_stpbv::detail
