// How large a volume is, how far it exceeds the convex hull it covers, where a point lies against it, and how
// far apart two volumes are that should be equal.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {

/// Excess over a convex hull inside the volume (m).
struct OverCover {
  double max;   ///< largest distance of a surface point from the hull: the largest difference of the support
                ///< functions
  double mean;  ///< mean height of the surface over the hull's faces, by area (along a segment, or of a
                ///< point, likewise)
};

/// Excess over the convex hull of the volume's vertices, or, given it, of the cloud that the volume was built
/// from: with a small R points of the hull lie inside and drop out.
OverCover overCover(const StpBv& volume);
/// Over the hull of the cloud. @throws Error for an empty cloud or a coordinate that is not finite.
OverCover overCover(const StpBv& volume, const std::vector<Eigen::Vector3d>& cloud);

/// Bound on the over-cover, R - sqrt(rho^2 - a^2/3), for a body whose faces are acute and whose longest edge
/// is `a` (m). The paper (III.C) prints a^2/12, which is the square of an equilateral face's inradius and too
/// small (docs/theory.md, 4).
double overCoverBound(const Radii& radii, double longestEdge);

/// Volume enclosed (m^3).
double enclosedVolume(const StpBv& volume);

/// Signed distance of a point from the surface, negative inside (m): the largest of n.p - h(n) over the
/// normals n. Exact at any depth; looks at every patch. -infinity for a point that is not finite.
double signedDistance(const StpBv& volume, const Eigen::Vector3d& point);

/// True where the point lies inside or on the surface, and where it is not finite.
bool contains(const StpBv& volume, const Eigen::Vector3d& point);

/// Largest distance between the two surfaces' tangent planes of the same normal, over the
/// normals of all faces' corners and a thousand more all around (m): from below, how far
/// the bodies are apart in Hausdorff's sense.
double surfaceDifference(const StpBv& a, const StpBv& b);

/// How many vertices of `a` have none of `b` within `radius` (m).
int withoutPartner(const StpBv& a, const StpBv& b, double radius);

}  // namespace fcl_stpbv
