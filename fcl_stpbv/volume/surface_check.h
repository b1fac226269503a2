// Whether what the builder made is the ball hull of its points.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv::detail {

/// What was built holds its points to rounding, the other points even to that of their height alone; is off
/// by more than that; or is no ball hull at all.
enum class Soundness { exact, sound, off, broken };

/// By local tests, in a time that grows with the number of patches: no walks and no search but for `others`,
/// the points that are no vertices. `points` are all of them.
/// `off`, where asked for, is the most that a point is outside a face's or an edge's ball, or a face's corner
/// off its own (m).
Soundness soundnessOf(const StpBv& volume, const std::vector<Eigen::Vector3d>& points,
                      const std::vector<Eigen::Vector3d>& others, double* off = nullptr);

/// A bound on how far the support function is off the points' own, beyond its rounding, where their heights
/// are off by that (m).
double supportErrorOf(const StpBv& volume, double off);

/// Solid angles of the patches' regions of normals, by Gauss and Bonnet, an edge's further parts with their
/// edge (sr); and the least angle by which a face's region turns left at a corner (rad).
struct RegionAngles {
  std::vector<double> area;
  double leastTurn = 0;
};
RegionAngles regionAngles(const StpBv& volume);

/// Largest height of a vertex over the ball of its own face or of one beside it (m). That decides for all
/// vertices and all balls where the regions of normals tile the sphere once: the patches are then one closed
/// convex surface whose radii of curvature are at most R, and any ball of radius R that touches such a
/// surface from around holds it (Blaschke).
double vertexHeight(const StpBv& volume);

/// Largest distances between two patches' core points at a common normal, on the
/// boundaries of an edge's region (m).
struct EdgeGap {
  double ends = 0;                   ///< to its vertices' patches
  double arc = 0;                    ///< along its middle, to the patches that hold those normals
  std::array<double, 2> side{0, 0};  ///< to its faces' patches

  double largest() const { return std::max(std::max(ends, arc), std::max(side[0], side[1])); }
};
EdgeGap edgeGap(const StpBv& volume, int edge);

}  // namespace fcl_stpbv::detail
