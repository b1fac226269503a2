// Measures of a finished volume: its size, how far it exceeds the convex hull that it covers, the distance of
// a point, the difference of two volumes that should be equal, and whether it is correct.
#pragma once

#include <Eigen/Core>
#include <string>
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

/// Result of verify(). Lengths in m.
struct Verification {
  bool ok = false;  ///< whether all errors are at the level of rounding
  /// Largest distance by which a point is less than `margin` below the surface; at most rounding error in a
  /// correct volume. Infinite, and `ok` false, if a point or the margin is not finite.
  double containment = 0;
  double solidAngleError = 0;  ///< sum of the regions' solid angles minus 4 pi (sr)
  /// Largest distance between the core points of two neighbouring patches at a normal on their common
  /// boundary.
  double boundaryGap = 0;
  std::string message;  ///< "ok", or what is wrong
};

/// Checks three things. All vertices lie inside all big balls, and `points`, if given, lie at least the
/// volume's r below the surface. The regions of normals tile the unit sphere. Neighbouring patches meet
/// (paper III.C: the surface is C1).
Verification verify(const StpBv& volume, const std::vector<Eigen::Vector3d>& points = {});
/// The same checks, but `points` must lie at least `margin` (m) below the surface, instead of r.
Verification verify(const StpBv& volume, const std::vector<Eigen::Vector3d>& points, double margin);

/// Solid angle of each patch's region of normals (sr), by spherical excess. The further parts of a split edge
/// are added to the edge's first patch.
std::vector<double> solidAngles(const StpBv& volume);

}  // namespace fcl_stpbv
