// Distance and least overlap of two convex hulls in long double, by the simplest methods.
#pragma once

#include <optional>

#include "test/reference/reference.h"

namespace fcl_stpbv::stability {

using test::Vector3L;

/// The points in the world's axes, relative to `origin` (the difference of two doubles is exact there).
std::vector<Vector3L> placedCorners(const test::Cloud& points, const Eigen::Isometry3d& pose,
                                    const Eigen::Vector3d& origin);

struct Nearest {
  bool overlap = false;  ///< whether they have a common point, to rounding
  bool proven = false;   ///< whether the plane across `difference` separates by its whole length, to rounding
  Vector3L difference{0, 0, 0};  ///< shortest vector from a point of hull a to one of hull b
};

/// The shortest difference of two hulls: Wolfe, "Finding the nearest point in a polytope" (1976), on the
/// differences of corners. Each pair of extreme corners that is nearer joins the active set.
Nearest nearestDifference(const std::vector<Vector3L>& a, const std::vector<Vector3L>& b);

/// The least overlap of two hulls over all normals of planes through three corners of one, and all cross
/// products of directions between corners. The true facets and edges are among them, and a wrong one has only
/// a larger overlap. No value if there are too many corners to try.
std::optional<long double> leastOverlap(const std::vector<Vector3L>& a, const std::vector<Vector3L>& b);

}  // namespace fcl_stpbv::stability
