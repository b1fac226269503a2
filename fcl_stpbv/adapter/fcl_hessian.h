// Second derivatives of the distance between FCL geometries.
#pragma once

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/distance/hessian.h"

namespace fcl_stpbv {

/// Derivatives at the answer `d` of `distance(geometry1, pose1, geometry2, pose2)`, twists about the origins
/// of the poses, world axes. Of a mesh or a tree the triangle or cell that `d.element` names is taken, so
/// they hold while it stays the nearest: `d.runnerUp` tells how far off the next one is. False, leaving
/// `result` alone, where they do not exist: an answer that is not exact (two STP-BVs: nor `local`), parallel
/// faces or edges of two geometries without an STP-BV, two meshes that overlap, an element that is gone.
/// Never throws or allocates.
bool hessian(const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
             const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2, const DistanceAnswer& d,
             DistanceHessian& result);

/// The same for two collision objects.
bool hessian(const fcl::CollisionObjectd& object1, const fcl::CollisionObjectd& object2,
             const DistanceAnswer& d, DistanceHessian& result);

/// Velocities of normal and witness points, under the same conditions.
bool rate(const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
          const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2, const DistanceAnswer& d,
          const BodyTwists& twists, DistanceRate& result);

}  // namespace fcl_stpbv
