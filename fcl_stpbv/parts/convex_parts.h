// Convex decomposition: covers a triangle mesh by a few convex parts.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fcl_stpbv/parts/mesh_solid.h"
#include "fcl_stpbv/volume/tessellate.h"

namespace fcl_stpbv {

/// How many parts to make, and how close they must be to the mesh.
struct PartsOptions {
  int most = 8;       ///< largest number of parts
  double excess = 0;  ///< if above 0: as few parts as keep their excess within it (m), but at most `most`
  double effort = 1;  ///< effort of the search; 1 is the default
};

/// One convex part of a mesh.
struct ConvexPart {
  std::vector<Eigen::Vector3d> points;  ///< the corners of its hull, in the mesh's frame (m)
  MeshExcess excess;                    ///< excess of the hull over the mesh as a solid
  MeshExcess openExcess;                ///< excess of the hull over the mesh's triangles alone
};

/// Result of a convex decomposition.
struct ConvexParts {
  std::vector<ConvexPart> parts;  ///< at least one
  double excess = 0;              ///< largest upper bound on a part's excess (m)
  double openExcess = 0;          ///< the same over the triangles alone (m)
  int pieces = 0;                 ///< number of connected pieces of the mesh; all are covered
  int closedPieces = 0;           ///< number of closed pieces, whose inside is covered too
  /// The hulls cover the mesh up to this length, because cuts are rounded (m). The r of an STP-BV is larger
  /// and covers it.
  double slack = 0;
};

/// Splits a mesh (m) into convex parts. By construction the parts cover every point of every triangle, and
/// the inside of closed pieces: planes cut the mesh into cells, and each part is the convex hull of the mesh
/// in some of the cells (docs/parts.md). The result depends only on the mesh and the options.
/// @throws Error as meshPieces() does.
ConvexParts convexParts(const TriangleMesh& mesh, const PartsOptions& options = {});

}  // namespace fcl_stpbv
