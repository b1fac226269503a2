// A ball around any geometry, made from the geometry alone.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <Eigen/Core>

namespace fcl_stpbv {
struct Body;
}

namespace fcl_stpbv::detail {

struct BoundingBall {
  Eigen::Vector3d centre;  ///< in the geometry's frame (m)
  double radius;           ///< (m)
};

/// The radius is infinite for a half space or a plane, for a mesh or an octree with nothing in it or with a
/// corner that is not finite, and for a geometry that the library cannot read.
BoundingBall boundingBall(const fcl::CollisionGeometryd& geometry);

/// A body's own sphere, in its link's frame. If its radius is not known, the ball around its geometry.
BoundingBall boundingBall(const Body& body);

}  // namespace fcl_stpbv::detail
