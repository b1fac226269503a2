// distance() for callers that ask about the same geometries again and again.
#pragma once

#include "fcl_stpbv/adapter/element_tree.h"
#include "fcl_stpbv/adapter/fcl_distance.h"

namespace fcl_stpbv::detail {

/// As the public distance(), but what `trees` has found of the geometries is not looked for again: boxes in
/// place of those that FCL has merged. `context.finite` then tells only that corners are numbers.
DistanceAnswer distance(const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
                        const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2,
                        const QueryContext& context, const KnownTrees& trees);

}  // namespace fcl_stpbv::detail
