// Approximates a convex body by a few triangles, for drawing.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include "fcl_stpbv/volume/tessellate.h"

namespace fcl_stpbv::report {

/// Triangles inside the body, with corners on its surface, counter-clockwise seen from outside. The body
/// reaches at most `tolerance` (m) beyond any triangle along the triangle's normal, unless that takes more
/// than `most` corners; then the largest gaps are filled first. Points in m, in the body's frame. Accepts any
/// bounded convex geometry that shapeOf() accepts, and STP-BVs as the smooth bodies that they are. Empty for
/// any other geometry.
TriangleMesh outline(const fcl::CollisionGeometryd& geometry, double tolerance, int most);

}  // namespace fcl_stpbv::report
