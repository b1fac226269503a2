// The ball rolling over one edge.
#pragma once

#include <Eigen/Core>

#include "fcl_stpbv/volume/rolling_cloud.h"

namespace fcl_stpbv::detail {

/// Whether the ball that has the edge as its diameter contains no other point. Only a point in this ball can
/// leave the rolling ball and enter it again within half a turn, and only then can two vertices be joined by
/// two edges.
bool isLone(const RollingCloud& cloud, int a, int b);

/// The ball rests on a and b, with its normal turned towards `across`. Returns the angle by which it rolls
/// until p is outside (rad); negative if p never is.
double leavingAngle(const RollingCloud& cloud, int a, int b, const Eigen::Vector3d& across, int p);

/// Rolls the ball over the edge a -> b, away from the face on its left, and returns the face on which it
/// comes to rest. `across` is the part of the ball's normal perpendicular to the edge, of unit length.
/// `candidate` is any point on which the ball may come to rest. `lone` is isLone(a, b).
/// @throws Error if rounding errors prevent it from coming to rest.
Ring pivot(RollingCloud& cloud, int a, int b, const Eigen::Vector3d& across, int candidate, bool lone);

}  // namespace fcl_stpbv::detail
