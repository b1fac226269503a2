// The vertices of a polytope, four at a time.
#pragma once

#include <Eigen/Core>

namespace fcl_stpbv::detail {

/// The mean of the vertices, no number where one of theirs is none, and how far the furthest of them is from
/// a given point.
struct Spread {
  Eigen::Vector3d middle;  ///< (m)
  double reach;            ///< (m)
};
Spread spreadAbout(const Eigen::Vector3d& point, const Eigen::Vector3d* vertices, int count);

/// The one furthest along `d` (any length), the first of several. At least one vertex.
int furthestAlong(const Eigen::Vector3d& d, const Eigen::Vector3d* vertices, int count);

/// How many of them have a height of `least` or more along `d`; the first `room` of these are put into
/// `found`.
int fromHeight(double least, const Eigen::Vector3d& d, const Eigen::Vector3d* vertices, int count, int* found,
               int room);

/// How many of them some unit vector within `chord` of the unit vector `n` may have as high as `v` or higher;
/// the first `room` of these are put into `found`.
int notBelow(const Eigen::Vector3d& v, const Eigen::Vector3d& n, double chord,
             const Eigen::Vector3d* vertices, int count, Eigen::Vector3d* found, int room);

}  // namespace fcl_stpbv::detail
