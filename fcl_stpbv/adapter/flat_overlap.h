// Two simple shapes without an STP-BV that overlap: the shortest translation that separates them.
#pragma once

#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/distance/shape.h"

namespace fcl_stpbv {

/// How deep two bounded shapes whose cores have a common point are in each other, by a polytope that grows
/// inside their Minkowski difference (van den Bergen 2001). Status `exact` where both bounds agree to
/// rounding, as on a face of the difference of two polytopes; else `bounded`, within 1e-6 of the cores'
/// depth unless rounding or the size of the polytope stopped it sooner. `distance` is the translation along
/// `normal` that does separate them, so it equals `lower`. Never throws or allocates.
Distance flatOverlap(const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b,
                     const Eigen::Isometry3d& poseB);

/// A half space or a plane `a` and a bounded shape: closed form, `exact`. A plane is left by the nearer side.
Distance planeDistance(const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b,
                       const Eigen::Isometry3d& poseB);

}  // namespace fcl_stpbv
