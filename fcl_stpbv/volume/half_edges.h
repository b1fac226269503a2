// The half-edges of a closed surface, each with its twin and the angle by which the ball rolls from one face
// to the other.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fcl_stpbv::detail {

/// A half-edge of a closed surface of rings, with the half-edge on its other side.
struct HalfEdge {
  int face, corner;  ///< runs from ring[corner] to the next vertex of faces[face]
  int twin = -1;     ///< index of the half-edge on the other side
  double turn = 0;   ///< angle by which the ball rolls from this face to the twin's, [0, 2 pi]
};

/// Half-edges of `faces` in order, paired with their twins. Two vertices may be joined by several edges. Then
/// the twin of a half-edge is the one that the rolling ball reaches first. `normals[f]` is the unit outward
/// normal at the face's first vertex.
/// @throws Error if the faces do not form a closed surface.
std::vector<HalfEdge> pairHalfEdges(const std::vector<Eigen::Vector3d>& points,
                                    const std::vector<std::vector<int>>& faces,
                                    const std::vector<Eigen::Vector3d>& normals, double radius);

}  // namespace fcl_stpbv::detail
