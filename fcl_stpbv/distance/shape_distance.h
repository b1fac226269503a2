// Exact signed distance between an STP-BV and a simple convex body or a point; and of two simple shapes,
// certified but without a continuous gradient.
#pragma once

#include "fcl_stpbv/convex/shape.h"
#include "fcl_stpbv/distance/distance.h"

namespace fcl_stpbv {

/// Signed distance between `volume` placed at `poseVolume` and `shape` placed at `poseShape`. One strictly
/// convex body in a pair is enough for a C1 distance (paper Th. 2.1). Never throws, allocates or returns NaN.
///
/// `exact` while the two cores are apart, that is down to a penetration of the volume's margin plus the
/// shape's, and always for half spaces and planes. Body 1 of the result is the volume; `patch[1]` is -1.
Distance distance(const StpBv& volume, const Eigen::Isometry3d& poseVolume, const Shape& shape,
                  const Eigen::Isometry3d& poseShape, PairCache* cache = nullptr);

/// The same with the shape as body 1.
Distance distance(const Shape& shape, const Eigen::Isometry3d& poseShape, const StpBv& volume,
                  const Eigen::Isometry3d& poseVolume, PairCache* cache = nullptr);

/// Signed distance of a world point; `normal` points from the volume to the point.
Distance distance(const StpBv& volume, const Eigen::Isometry3d& pose, const Eigen::Vector3d& point,
                  PairCache* cache = nullptr);

/// Signed distance of two shapes, one of them bounded. Never throws or allocates.
///
/// A half space or a plane: closed form. Cores apart: GJK. Cores that overlap: EPA. Normal and points to
/// rounding by Newton's method on the features that face each other. Status `exact`
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
/// is negative. False for an invalid pair. Where a plane between them tells, the cache keeps its normal.
bool isFartherThan(double x, const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b,
                   const Eigen::Isometry3d& poseB, PairCache* cache = nullptr);

/// A point of both of two bounded shapes that overlap, to rounding (world, m); of two that do not, one
/// between them. The pair must be valid.
Eigen::Vector3d commonPoint(const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b,
                            const Eigen::Isometry3d& poseB);

}  // namespace fcl_stpbv
