// An STP-BV against a BVHModel of any bounding volume, through the model's own hierarchy.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include "fcl_stpbv/adapter/nearest_element.h"

namespace fcl_stpbv {

/// Offers the triangles (or the points of a point cloud) that may be nearest to `search`, near branches
/// first. False when the geometry is no BVHModel of a known kind.
bool searchMesh(const fcl::CollisionGeometryd& mesh, NearestElement& search);

}  // namespace fcl_stpbv
