// Threshold tests: whether an STP-BV is farther from another one, or from a simple shape, than a given
// length. Cheaper than a distance query.
#pragma once

#include "fcl_stpbv/convex/shape.h"
#include "fcl_stpbv/distance/distance.h"

namespace fcl_stpbv::detail {

/// Whether the volumes are certainly farther apart than `x` (m). A negative `x` tests whether they overlap by
/// less than `-x`. It tries balls in and around both, a plane, GJK on the vertices, and only then the
/// distance. False for a pose that is not rigid. Never throws or allocates.
bool isFartherThan(double x, const StpBv& a, const Eigen::Isometry3d& poseA, const StpBv& b,
                   const Eigen::Isometry3d& poseB, PairCache* cache = nullptr);

/// The same test for a volume and a simple shape. It tries balls in and around the volume, a feature walk of
/// a few steps, GJK on the cores, and only then the distance.
bool isFartherThan(double x, const StpBv& volume, const Eigen::Isometry3d& poseVolume, const Shape& shape,
                   const Eigen::Isometry3d& poseShape, PairCache* cache = nullptr);

/// The cheap part of the test: the balls around the volumes, and the plane of the cached normal, if any.
bool isFartherByBounds(double x, const StpBv& a, const Eigen::Isometry3d& poseA, const StpBv& b,
                       const Eigen::Isometry3d& poseB, const PairCache& cache);
bool isFartherByBounds(double x, const StpBv& volume, const Eigen::Isometry3d& poseVolume, const Shape& shape,
                       const Eigen::Isometry3d& poseShape, const PairCache& cache);

}  // namespace fcl_stpbv::detail
