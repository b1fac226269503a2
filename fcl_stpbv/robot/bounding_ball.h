// A ball around any geometry, made from the geometry alone.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <Eigen/Core>

namespace fcl_stpbv::detail {

struct BoundingBall {
  Eigen::Vector3d centre;  ///< in the geometry's frame (m)
  double radius;           ///< (m)
};

/// The radius is infinite for a half space or a plane, and for a mesh or an octree whose box FCL has not
/// computed yet (computeLocalAABB()).
BoundingBall boundingBall(const fcl::CollisionGeometryd& geometry);

}  // namespace fcl_stpbv::detail
