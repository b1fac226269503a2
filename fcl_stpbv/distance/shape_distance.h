// Exact signed distance between an STP-BV and a simple convex body, and point queries.
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

}  // namespace fcl_stpbv
