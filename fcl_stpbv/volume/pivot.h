// The ball rolling over one edge.
#pragma once

#include <Eigen/Core>

#include "fcl_stpbv/volume/rolling_cloud.h"

namespace fcl_stpbv::detail {

/// Whether no point but its ends lies in the ball over the edge as diameter. Only such points can leave the
/// rolling ball and come back into it within half a turn, and only where there is one can two vertices be
/// joined by two edges.
bool isLone(const RollingCloud& cloud, int a, int b);

/// Angle by which the ball, resting on a and b with its normal turned towards `across`, rolls until it leaves
/// p; negative where it never does.
double leavingAngle(const RollingCloud& cloud, int a, int b, const Eigen::Vector3d& across, int p);

/// Rolls over the edge a -> b away from the face on its left and returns the face where the ball comes to
/// rest. `across` is the unit part of the ball's normal across the edge, `candidate` any point it may come to
/// rest on; `lone` is isLone(a, b).
/// @throws Error where rounding leaves it no rest.
Ring pivot(RollingCloud& cloud, int a, int b, const Eigen::Vector3d& across, int candidate, bool lone);

}  // namespace fcl_stpbv::detail
