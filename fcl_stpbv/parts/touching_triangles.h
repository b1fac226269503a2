// How the triangles of a closed mesh meet the prism over a triangle of another surface.
#pragma once

#include <Eigen/Core>

#include "fcl_stpbv/parts/mesh_solid.h"

namespace fcl_stpbv::detail {

/// A triangle of a surface, seen from a mesh.
struct SeenTriangle {
  const Triangle& corners;
  const Eigen::Vector3d& normal;  ///< unit
  const Eigen::Vector3d& middle;
  double smaller;  ///< the sides of the prism are this far inside the triangle's sides (m)
  double slack;    ///< mesh triangles within four times this of the triangle's plane touch it (m)
};

/// The mesh triangles that meet the prism near the triangle's plane.
struct TouchingTriangles {
  static constexpr int kMost = 8;  ///< the search ends after so many crossings and one more

  bool above = false, below = false, flat = false;  ///< sides on which triangles touch the plane
  int crossings = 0;                                ///< number of triangles that cross it
  int crossing = -1;                                ///< the one of these with most area in the prism
};

/// Finds them among the triangles of the mesh's closed pieces.
TouchingTriangles trianglesTouching(const MeshSolid& mesh, const SeenTriangle& seen);

}  // namespace fcl_stpbv::detail
