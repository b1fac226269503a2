// Converts FCL's simple geometries to this library's shapes.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include "fcl_stpbv/convex/shape.h"

namespace fcl_stpbv::detail {

/// Fills `shape` from a Sphere, Capsule, Ellipsoid, Box, Cylinder, Cone, Convex, Halfspace, Plane or
/// TriangleP; false for any other type. A Convex lends its own vertices: nothing is copied or allocated, and
/// the geometry must outlive the shape.
bool shapeOf(const fcl::CollisionGeometryd& geometry, Shape& shape);

}  // namespace fcl_stpbv::detail
