// The regions of normals of vertices and faces as areas bounded by arcs, for viewing and for measuring.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv::detail {

inline const Eigen::Vector3d& at(const StpBv& volume, int vertex) { return volume.vertices()[at(vertex)]; }

/// Part of a circle on the unit sphere: `start` turned about the unit `axis` by up to `turn` (rad).
struct Arc {
  Eigen::Vector3d start, axis;
  double turn;
  /// The edge whose region of normals the arc bounds; -1 for half a sphere, which has no edge.
  int edge = -1;
  Eigen::Vector3d at(double part) const;  ///< the point after a share `part` of the turn, 0 to 1
};

/// A region with its counter-clockwise boundary, and a centre from which the region is star-shaped.
struct Region {
  int patch;
  Eigen::Vector3d centre;
  std::vector<Arc> boundary;

  /// Normal at a share `out` of the way from the centre to `boundary[arc].at(part)`.
  Eigen::Vector3d normal(std::size_t arc, double part, double out) const;
};

/// Integral of the normals over a region: half the integral of n x dn along its boundary.
Eigen::Vector3d vectorArea(const Region& region);

/// Regions of all vertices, then of all faces (paper III.D). The sphere of a single point is given as two
/// halves.
std::vector<Region> regions(const StpBv& volume);

/// The smallest kappa / rho of all edges, the cosine of the largest lean of a normal; 1 without edges. Near
/// the smallest R some normals of an edge are almost parallel to the edge, and rounding errors are then
/// larger by the inverse of this cosine.
double leastCosine(const StpBv& volume);

/// The arc of an edge's normals halfway between its ends, from its first face to its second. A spindle's arc
/// is a full circle.
Arc edgeArc(const StpBv& volume, int edge);

}  // namespace fcl_stpbv::detail
