// Makes a volume with fewer vertices around the same points, within a limit on the over-cover.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {

/// A volume with few vertices around `points` (m). Every point lies at least `options.r` below its surface,
/// and the volume exceeds the points' convex hull by at most `overCover` (m). Its big radius is `options.R`.
/// Its small radius is larger than `options.r`, so that it also covers the points that are no vertices. If a
/// sphere or a spindle (one or two vertices) is enough, the result is one. Otherwise vertices are added where
/// the points stick out most, then removed while the limit allows. The number of vertices is small, but not
/// proven to be minimal. `verify(volume, points, options.r)` checks the margin. The time grows at least with
/// the square of the number of vertices: 5 s for 500 vertices all over a sphere, half a minute for 1000.
/// @throws Error as StpBv::build() does, and if the volume with all points as vertices already exceeds the
/// limit. The message states its over-cover.
StpBv::Ptr reduce(const std::vector<Eigen::Vector3d>& points, const StpBvOptions& options, double overCover);

}  // namespace fcl_stpbv
