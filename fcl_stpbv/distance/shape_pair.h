// Two simple shapes without an STP-BV between them: a certified distance, but no continuous gradient.
#pragma once

#include "fcl_stpbv/convex/shape.h"
#include "fcl_stpbv/distance/distance.h"

namespace fcl_stpbv {

/// Signed distance of two shapes, one of them bounded. Never throws or allocates.
///
/// A half space or a plane: closed form. Cores apart: GJK. Cores that overlap: EPA. Status `exact`
/// where both bounds agree to rounding, `bounded` where they do not; at overlap of round bodies within
/// 1e-6 of the cores' depth, unless rounding or the size of the polytope stopped it sooner. `invalid`
/// for a shape that is not `valid()`, a pose that is not rigid, and two unbounded shapes. Both orders
/// give the same answer seen from the other side.
///
/// Apart, `distance` is that of the two witness points; overlapping, the
/// translation along `normal` that separates.
Distance distance(const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b,
                  const Eigen::Isometry3d& poseB);

/// Whether the two shapes are certainly farther apart than `x` (m): the same searches,
/// ended as soon as a bound tells. Overlapping shapes are asked for their depth where `x`
/// is negative. False for an invalid pair.
bool isFartherThan(double x, const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b,
                   const Eigen::Isometry3d& poseB);

/// A point of both of two bounded shapes that overlap, to rounding (world, m); of two that do not, one
/// between them. The pair must be valid.
Eigen::Vector3d commonPoint(const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b,
                            const Eigen::Isometry3d& poseB);

}  // namespace fcl_stpbv
