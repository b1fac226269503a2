// Checks whether a volume is the ball hull of its points.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv::detail {

/// Result of the check. `exact` and `sound`: the volume contains its points up to rounding. For `exact` the
/// points that are no vertices are inside up to the rounding of their height alone. `off`: the volume misses
/// points by more than rounding. `broken`: the volume is no ball hull at all.
enum class Soundness { exact, sound, off, broken };

/// Uses only local tests, so the time is linear in the number of patches. Only `others`, the points that are
/// no vertices, need a search. `points` are all points of the cloud. Unless `off` is null, it receives the
/// largest distance by which a point is outside a face's or an edge's ball, or by which a face's corner is
/// off the face's own ball (m).
Soundness soundnessOf(const StpBv& volume, const std::vector<Eigen::Vector3d>& points,
                      const std::vector<Eigen::Vector3d>& others, double* off = nullptr);

/// Upper bound on the error of the support function beyond its rounding, if the heights of points are off by
/// `off` (m).
double supportErrorOf(const StpBv& volume, double off);

/// `area`: solid angles of the patches' regions of normals, by Gauss and Bonnet (sr); the further parts of an
/// edge are counted with the edge's first patch. `leastTurn`: the least angle by which a face's region turns
/// left at a corner (rad).
struct RegionAngles {
  std::vector<double> area;
  double leastTurn = 0;
};
RegionAngles regionAngles(const StpBv& volume);

/// Largest height of a vertex over the ball of its own face or of a neighbouring face (m). If the regions of
/// normals tile the sphere once, this test decides for all vertices and all balls: the patches then form one
/// closed convex surface whose radii of curvature are at most R, and any ball of radius R that touches such a
/// surface, with the surface on its inner side, contains it (Blaschke's theorem).
double vertexHeight(const StpBv& volume);

/// Largest distances between the core points of two patches at a common normal, on the boundaries of an
/// edge's region (m).
struct EdgeGap {
  double ends = 0;                   ///< to the patches of its vertices
  double arc = 0;                    ///< along its middle, to the patches that own the normals there
  std::array<double, 2> side{0, 0};  ///< to the patches of its faces

  double largest() const { return std::max(std::max(ends, arc), std::max(side[0], side[1])); }
};
EdgeGap edgeGap(const StpBv& volume, int edge);

}  // namespace fcl_stpbv::detail
