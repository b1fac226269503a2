// A triangle mesh as a few convex point sets that together cover it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fcl_stpbv/parts/mesh_solid.h"
#include "fcl_stpbv/volume/tessellate.h"

namespace fcl_stpbv {

/// How many parts, or how good ones.
struct PartsOptions {
  int most = 8;       ///< no more parts than this
  double excess = 0;  ///< with a value: as few parts as reach it (m), still no more than `most`
  double effort = 1;  ///< of the search; 1 is the usual one
};

/// One convex part of a mesh.
struct ConvexPart {
  std::vector<Eigen::Vector3d> points;  ///< the corners of its hull (m)
  MeshExcess excess;                    ///< of the hull over the mesh's solid
  MeshExcess openExcess;                ///< over its triangles alone
};

/// All parts of a mesh.
struct ConvexParts {
  std::vector<ConvexPart> parts;  ///< at least one
  double excess = 0;              ///< largest upper bound of the parts'
  double openExcess = 0;          ///< the same over the triangles alone (m)
  int pieces = 0;                 ///< of the mesh: all is covered
  int closedPieces = 0;           ///< of these, whose inside is covered too
  /// Convex hulls cover to this length, for rounding of the cuts; a volume's r covers more (m).
  double slack = 0;
};

/// Parts cover every triangle, whole, and what closed pieces enclose, by construction: the mesh is cut by
/// planes into cells, and a part is the hull of all that some cells hold (docs/parts.md). The answer depends
/// on the mesh and the options alone.
/// @throws Error as meshPieces() does.
ConvexParts convexParts(const TriangleMesh& mesh, const PartsOptions& options = {});

}  // namespace fcl_stpbv
