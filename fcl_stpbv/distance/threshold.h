// Is an STP-BV farther from another, or from a simple shape, than a threshold? For less than a distance
// takes.
#pragma once

#include "fcl_stpbv/convex/shape.h"
#include "fcl_stpbv/distance/distance.h"

namespace fcl_stpbv::detail {

/// Whether the volumes are certainly farther apart than `x` (m; negative: whether they are less deep in each
/// other). Balls in and around both, a plane, GJK on the vertices, and only then the distance are asked.
/// False for a pose that is not rigid. Never throws or allocates.
bool isFartherThan(double x, const StpBv& a, const Eigen::Isometry3d& poseA, const StpBv& b,
                   const Eigen::Isometry3d& poseB, PairCache* cache = nullptr);

/// The same of a volume and a simple shape: balls in and around the volume, a walk of a few steps to the
/// distance, GJK on the cores, and only then the whole distance.
bool isFartherThan(double x, const StpBv& volume, const Eigen::Isometry3d& poseVolume, const Shape& shape,
                   const Eigen::Isometry3d& poseShape, PairCache* cache = nullptr);

/// By the cheap part: the balls around the volumes, and the plane of the cache's normal if it has one.
bool isFartherByBounds(double x, const StpBv& a, const Eigen::Isometry3d& poseA, const StpBv& b,
                       const Eigen::Isometry3d& poseB, const PairCache& cache);
bool isFartherByBounds(double x, const StpBv& volume, const Eigen::Isometry3d& poseVolume, const Shape& shape,
                       const Eigen::Isometry3d& poseShape, const PairCache& cache);

}  // namespace fcl_stpbv::detail
