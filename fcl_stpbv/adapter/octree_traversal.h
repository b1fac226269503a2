// An STP-BV against the occupied cells of an OcTree, through the tree itself.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include "fcl_stpbv/adapter/nearest_element.h"

namespace fcl_stpbv {

/// Offers the occupied leaves that may be nearest to `search`, as boxes; their ids are FCL's query cell ids.
/// False when the geometry is no OcTree, or FCL was built without octomap.
bool searchOcTree(const fcl::CollisionGeometryd& tree, NearestElement& search);

}  // namespace fcl_stpbv
