// Distance and least overlap of two convex hulls in long double, by the most pedestrian means there are.
#pragma once

#include <optional>

#include "test/reference/reference.h"

namespace fcl_stpbv::stability {

using test::Vector3L;

/// The points in the world's axes, relative to `origin` (a difference of two doubles is exact there).
std::vector<Vector3L> placedCorners(const test::Cloud& points, const Eigen::Isometry3d& pose,
                                    const Eigen::Vector3d& origin);

struct Nearest {
  bool overlap = false;  ///< a common point, to rounding
  bool proven = false;   ///< the plane across `difference` separates by all of its length, to rounding
  Vector3L difference{0, 0, 0};  ///< shortest vector from a point of hull a to one of hull b
};

/// The shortest difference of two hulls: Wolfe, "Finding the nearest point in a polytope" (1976), on the
/// differences of corners; each pair of extreme corners that comes nearer joins the active set.
Nearest nearestDifference(const std::vector<Vector3L>& a, const std::vector<Vector3L>& b);

/// The least overlap of two hulls over all normals of planes through three corners of one, and all products
/// of directions between corners: the true facets and edges are among them, and a wrong one only overlaps
/// more. Nothing where there are too many corners to try.
std::optional<long double> leastOverlap(const std::vector<Vector3L>& a, const std::vector<Vector3L>& b);

}  // namespace fcl_stpbv::stability
