// The polygon around points that lie in one plane to rounding.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fcl_stpbv/volume/ball_faces.h"

namespace fcl_stpbv::detail {

/// Corners of the convex polygon around the points, in order round it, as indices into the cloud. Every point
/// lies on the polygon or inside, to touchTolerance(). Empty if the points are not in one plane to this
/// tolerance, or if they lie on one line.
Ring flatOutline(const std::vector<Eigen::Vector3d>& points);

}  // namespace fcl_stpbv::detail
