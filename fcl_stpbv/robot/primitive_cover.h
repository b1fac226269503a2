// The STP-BV that covers a primitive: the ball itself, a spindle around a capsule, the corners of a box.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include "fcl_stpbv/volume/measure.h"

namespace fcl_stpbv::detail {

/// A volume around a primitive, and what it exceeds the primitive by (m):
/// largest is never less than the truth.
struct PrimitiveCover {
  StpBv::Ptr volume;  ///< null for a geometry that has none
  OverCover excess{0, 0};
};

/// A volume that contains a sphere, capsule, box, cylinder or cone, in the primitive's own frame.
///
/// A sphere is the volume of its centre with its own radius, exactly; a capsule lies in the spindle of its
/// two ends with its radius. A box keeps `radii.r` around its corners. So do a cylinder and a cone around a
/// prism or pyramid whose base is a regular polygon around the circle, by a quarter of r at the corners or by
/// 1/800 of the radius where 64 corners are not enough; their `mean` is taken over that prism or pyramid. A
/// primitive too large for `radii.R` gets a larger one.
PrimitiveCover primitiveCover(const fcl::CollisionGeometryd& primitive, const StpBvOptions& radii);

}  // namespace fcl_stpbv::detail
