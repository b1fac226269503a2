// The first face that a rolling ball touches.
#pragma once

#include <vector>

#include "fcl_stpbv/volume/rolling_cloud.h"

namespace fcl_stpbv::detail {

/// A first face, or the one or two points that carry none: of one point, two points, or collinear ones.
struct FirstFace {
  Ring ring;
  std::vector<int> lone;
};

/// Lets the ball touch a first, a second and a third point.
/// @throws Error where rounding defeats it from all sides.
FirstFace firstFace(RollingCloud& cloud);

}  // namespace fcl_stpbv::detail
