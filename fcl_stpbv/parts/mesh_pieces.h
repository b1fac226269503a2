// Which triangles of a mesh hang together, and which of the pieces enclose a space.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fcl_stpbv/volume/tessellate.h"

namespace fcl_stpbv {

/// A mesh taken apart into pieces whose triangles share edges. A piece is closed where each of its edges is
/// run through as often one way as the other, after triangles were turned to agree with their neighbours: its
/// winding number about a point then is a whole number, and where that is not 0 the piece encloses the point.
/// Flipped faces, nested shells and holes are the rule in robots' meshes, so none of them is an error.
struct MeshPieces {
  std::vector<Eigen::Vector3d> vertices;      ///< each point once (m)
  std::vector<std::array<int, 3>> triangles;  ///< turned; lines that are an edge of another are left out
  std::vector<int> piece;                     ///< of each triangle
  std::vector<char> closed;                   ///< of each piece
  /// Number of pieces.
  int pieces() const { return static_cast<int>(closed.size()); }
  /// Number of closed pieces.
  int closedPieces() const;
};

/// @throws Error for a mesh without triangles, an index out of range or a coordinate that is not finite.
MeshPieces meshPieces(const TriangleMesh& mesh);

}  // namespace fcl_stpbv
