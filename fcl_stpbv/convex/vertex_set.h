// Loops over the vertices of a polytope, four vertices at a time (SIMD).
#pragma once

#include <Eigen/Core>

namespace fcl_stpbv::detail {

/// The mean of the vertices (NaN if a coordinate is NaN), and the distance of the vertex furthest from a
/// given point.
struct Spread {
  Eigen::Vector3d middle;  ///< (m)
  double reach;            ///< (m)
};
Spread spreadAbout(const Eigen::Vector3d& point, const Eigen::Vector3d* vertices, int count);

/// The vertex furthest along `d` (any length); the first one if there are several. `count` is at least 1.
int furthestAlong(const Eigen::Vector3d& d, const Eigen::Vector3d* vertices, int count);

/// The number of vertices with a height of at least `least` along `d`. The first `room` of them are written
/// to `found`.
int fromHeight(double least, const Eigen::Vector3d& d, const Eigen::Vector3d* vertices, int count, int* found,
               int room);

/// The number of vertices that may be as high as `v` or higher along some unit vector within the distance
/// `chord` of the unit vector `n`. The first `room` of them are written to `found`.
int notBelow(const Eigen::Vector3d& v, const Eigen::Vector3d& n, double chord,
             const Eigen::Vector3d* vertices, int count, Eigen::Vector3d* found, int room);

}  // namespace fcl_stpbv::detail
