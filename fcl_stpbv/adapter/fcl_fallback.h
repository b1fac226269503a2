// fcl::distance as it can be trusted: unsigned, at a fine tolerance, its exceptions and garbage kept away.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include "fcl_stpbv/adapter/fcl_distance.h"

namespace fcl_stpbv {

/// What FCL says about a pair that is not two STP-BVs. Both poses must be finite. Status `invalid` for types
/// that FCL's distance does not know: planes, half spaces, triangles, meshes other than RSS, kIOS and OBBRSS,
/// empty meshes and trees.
DistanceAnswer fallbackDistance(const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
                                const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2);

}  // namespace fcl_stpbv
