// Fewer vertices for the same body, within a budget for the over-cover.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {

/// A volume of few vertices around `points`: all of them stay under its surface by at least `options.r`, and
/// it exceeds their convex hull by at most `overCover` (m). Its big radius is `options.R`; its own r is
/// larger than `options.r` by what the points left out stick out. A point or a segment (sphere, spindle)
/// serves where it fits. Vertices are taken where the points stick out most, then dropped while the budget
/// allows: few, not proven to be the fewest. `verify(volume, points, options.r)` proves the margin. The time
/// grows with the square of the number of vertices and faster: 5 s for 500 all over a sphere, half a minute
/// for 1000.
/// @throws Error as StpBv::build() does, and where even the volume of all points exceeds the
/// budget; the message states the over-cover it has.
StpBv::Ptr reduce(const std::vector<Eigen::Vector3d>& points, const StpBvOptions& options, double overCover);

}  // namespace fcl_stpbv
