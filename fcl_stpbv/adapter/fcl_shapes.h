// FCL's simple geometries as the shapes that the distance to an STP-BV is solved for.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include "fcl_stpbv/convex/shape.h"

namespace fcl_stpbv::detail {

/// Fills `shape` from a Sphere, Capsule, Ellipsoid, Box, Cylinder, Cone, Convex, Halfspace, Plane or
/// TriangleP; false for any other type. A Convex lends its own vertices: nothing is copied or allocated, and
/// the geometry must outlive the shape.
bool shapeOf(const fcl::CollisionGeometryd& geometry, Shape& shape);

}  // namespace fcl_stpbv::detail
