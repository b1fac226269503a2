// Onto the core of a simple shape, where rounding or a search left a point beside it.
#pragma once

#include <Eigen/Core>

#include "fcl_stpbv/convex/shape.h"

namespace fcl_stpbv::detail {

/// A point of the core next to `y`, the nearest one to first order. Frame and units of the shape.
Eigen::Vector3d ontoCore(const Shape& core, const Eigen::Vector3d& y);

}  // namespace fcl_stpbv::detail
