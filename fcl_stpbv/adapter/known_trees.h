// distance() for callers that ask about the same geometries again and again.
#pragma once

#include "fcl_stpbv/adapter/element_tree.h"
#include "fcl_stpbv/adapter/fcl_distance.h"

namespace fcl_stpbv::detail {

/// Like the public distance(), but reuses `trees`, which already contain the boxes that replace merged ones.
/// `context.finite` then only states that all vertices are finite.
DistanceAnswer distance(const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
                        const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2,
                        const QueryContext& context, const KnownTrees& trees);

}  // namespace fcl_stpbv::detail
