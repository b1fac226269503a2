// The questions whose answer needs no full distance: collision with a
// margin, farther than, a point's distance.
#pragma once

#include "fcl_stpbv/adapter/fcl_distance.h"

namespace fcl_stpbv {

/// Whether the geometries are certainly farther apart than `x` (m; negative:
/// whether they are less deep in each other).
///
/// For every pair of types, with or without an STP-BV. Meshes and trees are walked down from both
/// roots: pairs of boxes farther apart are left out, and the first pair of elements that is not ends
/// the walk. Of two bodies balls, the supporting planes of the remembered normal, and only then a
/// search are asked, which ends as soon as its bounds tell where neither is an STP-BV. False for a pair
/// without an answer: nothing is certain about it.
bool isFartherThan(double x, const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
                   const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2,
                   const QueryContext& context = {});

/// Whether the geometries come within `margin` (m) of each other; what is not known counts as a collision.
inline bool collides(const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
                     const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2,
                     double margin = 0.0, const QueryContext& context = {}) {
  return !isFartherThan(margin, geometry1, pose1, geometry2, pose2, context);
}

/// Signed distance of a world point to an STP-BV; `normal` points from the volume to the point.
Distance distance(const StpBvGeometry& geometry, const fcl::Transform3d& pose, const Eigen::Vector3d& point,
                  PairCache* cache = nullptr);

}  // namespace fcl_stpbv
