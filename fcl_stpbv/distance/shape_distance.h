// Exact signed distance between an STP-BV and a simple convex shape or a point. Also between two simple
// shapes: certified, but without a continuous gradient.
#pragma once

#include "fcl_stpbv/convex/shape.h"
#include "fcl_stpbv/distance/distance.h"

namespace fcl_stpbv {

/// Signed distance between `volume` placed at `poseVolume` and `shape` placed at `poseShape`. The distance is
/// C1, because one strictly convex body in a pair is enough (paper Th. 2.1). Never throws, allocates or
/// returns NaN.
///
/// The status is `exact` while the two cores are apart, that is, down to a penetration of the volume's r plus
/// the shape's margin, and always for half spaces and planes. Body 1 of the result is the volume; `patch[1]`
/// is -1.
Distance distance(const StpBv& volume, const Eigen::Isometry3d& poseVolume, const Shape& shape,
                  const Eigen::Isometry3d& poseShape, PairCache* cache = nullptr);

/// The same with the shape as body 1.
Distance distance(const Shape& shape, const Eigen::Isometry3d& poseShape, const StpBv& volume,
                  const Eigen::Isometry3d& poseVolume, PairCache* cache = nullptr);

/// Signed distance of a point (world, m) to the volume; `normal` points from the volume to the point.
Distance distance(const StpBv& volume, const Eigen::Isometry3d& pose, const Eigen::Vector3d& point,
                  PairCache* cache = nullptr);

/// Signed distance of two shapes, at least one of them bounded. Never throws or allocates.
///
/// The method depends on the pair. A half space or a plane: closed form. Cores apart: GJK. Cores that
/// overlap: EPA. Newton's method on the two nearest features then makes normal and points accurate to
/// rounding. The status is `exact` if both bounds agree up to rounding, else `bounded`. For overlapping round
/// bodies the bounds then agree within 1e-6 of the cores' depth, unless rounding or the size limit of EPA's
/// polytope stops the search sooner. The status is `invalid` for a shape that is not `valid()`, a pose that
/// is not rigid, and two unbounded shapes. Both orders of the shapes give the same answer, with the bodies
/// exchanged.
///
/// For shapes that are apart, `distance` is the distance of the two witness points. For shapes that overlap,
/// it is minus the length of the translation along `normal` that separates them.
Distance distance(const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b,
                  const Eigen::Isometry3d& poseB);

/// Whether the two shapes are certainly farther apart than `x` (m). Uses the same searches as distance(), but
/// stops as soon as a bound decides. For overlapping shapes the depth is searched only if `x` is negative.
/// False for an invalid pair. If a plane between the shapes decides, the cache keeps its normal.
bool isFartherThan(double x, const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b,
                   const Eigen::Isometry3d& poseB, PairCache* cache = nullptr);

/// A common point of two bounded shapes that overlap, up to rounding (world, m). If they do not overlap, a
/// point between them. The pair must be valid.
Eigen::Vector3d commonPoint(const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b,
                            const Eigen::Isometry3d& poseB);

}  // namespace fcl_stpbv
