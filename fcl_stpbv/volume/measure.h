// Measures of a volume: its size, how far it exceeds the convex hull that it covers, the distance of a point,
// and the difference of two volumes that should be equal.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {

/// Over-cover: how far a volume exceeds a convex hull inside it (m).
struct OverCover {
  /// Largest distance of a surface point from the hull, which is the largest difference of the two support
  /// functions.
  double max;
  /// Mean height of the surface over the hull's faces, weighted by area (over the segment or the point if the
  /// hull is one).
  double mean;
};

/// Over-cover over the convex hull of the volume's vertices. With a small R some corners of the cloud's hull
/// lie inside the volume and are no vertices; then use the overload that takes the cloud.
OverCover overCover(const StpBv& volume);
/// Over-cover over the convex hull of the cloud that the volume was built from. @throws Error for an empty
/// cloud or a coordinate that is not finite.
OverCover overCover(const StpBv& volume, const std::vector<Eigen::Vector3d>& cloud);

/// Upper bound on the over-cover (m): R - sqrt(rho^2 - a^2/3), for a body whose faces are acute triangles and
/// whose longest edge is `a` (m). The paper (III.C) prints a^2/12 in place of a^2/3. That is the square of an
/// equilateral face's inradius and too small (docs/theory.md, 4).
double overCoverBound(const Radii& radii, double longestEdge);

/// Volume enclosed (m^3).
double enclosedVolume(const StpBv& volume);

/// Signed distance of a point from the surface, negative inside (m): the largest of n.p - h(n) over the
/// normals n. Exact at any depth. Checks every patch. -infinity if a coordinate is not finite.
double signedDistance(const StpBv& volume, const Eigen::Vector3d& point);

/// Whether the point lies inside the volume or on its surface; also true if a coordinate is not finite.
bool contains(const StpBv& volume, const Eigen::Vector3d& point);

/// Lower bound on the Hausdorff distance of two bodies (m). It is the largest difference of their support
/// functions over the normals of all faces' corners and a thousand more directions all around.
double surfaceDifference(const StpBv& a, const StpBv& b);

/// Number of vertices of `a` that have no vertex of `b` within `radius` (m).
int withoutPartner(const StpBv& a, const StpBv& b, double radius);

}  // namespace fcl_stpbv
