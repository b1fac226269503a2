// The first face that a rolling ball touches.
#pragma once

#include <vector>

#include "fcl_stpbv/volume/rolling_cloud.h"

namespace fcl_stpbv::detail {

/// A first face. A cloud without a face (one point, two points, or collinear points) gives one or two points
/// instead.
struct FirstFace {
  Ring ring;
  std::vector<int> lone;
};

/// Lets the ball touch a first, a second and a third point.
/// @throws Error if it fails because of rounding from all starting directions.
FirstFace firstFace(RollingCloud& cloud);

}  // namespace fcl_stpbv::detail
