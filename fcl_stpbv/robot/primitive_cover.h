// The STP-BV that covers a primitive: the ball itself, a spindle around a capsule, the corners of a box.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include "fcl_stpbv/volume/measure.h"

namespace fcl_stpbv::detail {

/// A volume around a primitive, and how much it exceeds the primitive (m). `excess.max` is never less than
/// the true value.
struct PrimitiveCover {
  StpBv::Ptr volume;  ///< null for a geometry without a cover
  OverCover excess{0, 0};
};

/// A volume that contains a sphere, capsule, box, cylinder or cone, in the primitive's own frame.
///
/// By type:
/// - A sphere is exactly the volume of its centre, with its own radius as r.
/// - A capsule lies in the spindle of its two end points, with its radius as r.
/// - A box is the volume of its corners, with `radii.r`.
/// - A cylinder or cone is covered by the volume of a prism or pyramid, with `radii.r`. The base is a regular
///   polygon around the circle. Its corners exceed the circle by a quarter of r, or by 1/800 of the radius if
///   64 corners are not enough for that. The `mean` of the excess is over that prism or pyramid.
/// A primitive that is too large for `radii.R` gets a larger R.
PrimitiveCover primitiveCover(const fcl::CollisionGeometryd& primitive, const StpBvOptions& radii);

}  // namespace fcl_stpbv::detail
