// Two simple shapes without an STP-BV between them: an exact distance, but no continuous gradient.
#pragma once

#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/distance/shape.h"

namespace fcl_stpbv {

/// Distance of two bounded shapes whose cores are apart, by GJK with the duality gap as its stop: FCL's own
/// stop is no proof of convergence (docs/fcl.md). Status `exact` where both bounds agree to rounding,
/// `bounded` where they do not, `invalid` where the cores overlap or nothing is known. Never throws or
/// allocates.
Distance flatDistance(const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b,
                      const Eigen::Isometry3d& poseB);

/// Whether the two shapes are certainly farther apart than `x` (m): the same search, ended as soon as one of
/// its bounds tells. Overlapping shapes are asked for their depth where `x` is negative.
bool flatFartherThan(double x, const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b,
                     const Eigen::Isometry3d& poseB);

}  // namespace fcl_stpbv
