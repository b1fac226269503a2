// Approximates a convex body by a few triangles, for drawing.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include "fcl_stpbv/volume/tessellate.h"

namespace fcl_stpbv::report {

/// Triangles inside the body, corners on its surface, counter-clockwise seen from outside. Along no
/// triangle's normal does the body reach further out than `tolerance` (m), unless that takes more than `most`
/// corners; then the largest gaps are filled first. Points in m, the body's frame. Takes any bounded convex
/// geometry that shapeOf() takes, and STP-BVs as the smooth bodies they are. Empty for any other one.
TriangleMesh outline(const fcl::CollisionGeometryd& geometry, double tolerance, int most);

}  // namespace fcl_stpbv::report
