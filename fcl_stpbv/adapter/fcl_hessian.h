// Second derivatives of the distance between FCL geometries.
#pragma once

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/distance/hessian.h"

namespace fcl_stpbv {

/// Second derivatives at the answer `d` of `distance(geometry1, pose1, geometry2, pose2)`; twists about the
/// origins of the poses, world axes. For a mesh or an octree they are those of the element (triangle or cell)
/// `d.element`. They hold while it stays the nearest one; `d.runnerUp` is the distance of the next one.
/// Returns false and does not change `result` if they do not exist: for an answer that is not `exact` (for
/// two STP-BVs `local` is allowed too), for parallel faces or edges of two geometries without an STP-BV, for
/// two meshes that overlap, and for an element that no longer exists. Never throws or allocates.
bool hessian(const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
             const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2, const DistanceAnswer& d,
             DistanceHessian& result);

/// hessian() for two collision objects.
bool hessian(const fcl::CollisionObjectd& object1, const fcl::CollisionObjectd& object2,
             const DistanceAnswer& d, DistanceHessian& result);

/// Velocities of the normal and the witness points (see DistanceRate), under the same conditions.
bool rate(const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
          const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2, const DistanceAnswer& d,
          const BodyTwists& twists, DistanceRate& result);

/// The same for two collision objects.
bool rate(const fcl::CollisionObjectd& object1, const fcl::CollisionObjectd& object2, const DistanceAnswer& d,
          const BodyTwists& twists, DistanceRate& result);

}  // namespace fcl_stpbv
