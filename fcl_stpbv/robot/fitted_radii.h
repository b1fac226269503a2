// Chooses r and R by a body's size, so that a thin finger does not get a margin of a centimetre.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv::detail {

/// The measures of a body that determine the radii (m).
struct BodySize {
  double width =
      0;            ///< smallest distance of two parallel planes with the body between them, or a little less
  double ball = 0;  ///< radius of the smallest ball around the body
};

/// The size of a cloud's convex hull. The width is a lower bound with a relative error of at most 1e-6 for
/// hulls of up to some hundred vertices. For finer round hulls the error depends on how far EPA got. @throws
/// Error for a cloud that is empty or not finite.
BodySize sizeOf(const std::vector<Eigen::Vector3d>& points);

/// r is 1/20 of the width, but at most 1 cm (the paper's value), and at least 1/250 of the ball's radius, so
/// that a flat body gets an r above 0. R is fittedR().
StpBvOptions fittedRadii(const BodySize& size);

/// The R for which the surface bulges beyond r by at most r, or by 1/200 of the ball's radius if that is
/// more. So the over-cover is at most r plus that bulge (docs/choosing_r_and_R.md).
double fittedR(double ball, double r);

/// The radii given, with an r and an R that fit the body where they are asked for; `size` is called only
/// then.
StpBvOptions withFitted(const StpBvOptions& given, bool fitSmallRadius, bool fitBigRadius,
                        const std::function<BodySize()>& size);

}  // namespace fcl_stpbv::detail
