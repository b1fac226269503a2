// The tables of a volume that queries read. They are made once, when the volume is built.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <vector>

#include "fcl_stpbv/packed.h"
#include "fcl_stpbv/volume/direction_table.h"
#include "fcl_stpbv/volume/patch_table.h"
#include "fcl_stpbv/volume/vertex_graph.h"

namespace fcl_stpbv::detail {

/// A box around the vertices, in the body's frame. Its first axis is along the longest edge. Its second axis
/// is along the edge that is longest perpendicular to the first.
struct BodyBox {
  Packed axis[3]{};  ///< unit, at right angles to each other
  Packed centre{};   ///< m
  Packed half{};     ///< half lengths along the axes (m)
  /// Whether the vertices are the box's corners, to rounding: the box is then the vertices' hull.
  bool isHull = false;
  /// Whether the body is so long or flat that the box bounds it more closely than a ball.
  bool isTelling = false;
};

/// `edges`: indices of the two ends of each edge.
BodyBox boxAround(const std::vector<Eigen::Vector3d>& vertices, const std::vector<std::array<int, 2>>& edges);

struct QueryTables {
  /// Upper bound on the error of the support function beyond its rounding (m), because the faces' balls fit
  /// the points only approximately (surface_check.h). The builder sets it after its check of the volume,
  /// before it hands the volume out.
  mutable double supportError = 0;
  PatchTable patches;  ///< the patches, with the boundaries of their regions of normals
  /// Some faces near the centre, nearest first, in different directions; each is the nearest one around its
  /// direction. The shortest way out of the body is likely along one of their normals.
  std::vector<int> shallowFaces;
  double capHeight = std::numeric_limits<double>::infinity();  ///< see capHeight() in point_depth.h (m)
  BodyBox box;
  /// The edges at each vertex, for climbing from vertex to vertex.
  VertexGraph graph;
  /// For each cell of directions, the patch whose region contains the cell's middle.
  DirectionTable patchNear;
  DirectionTable vertexNear;  ///< for each cell of directions, the vertex furthest along the cell's middle

  /// Memory of all tables, in bytes.
  std::size_t memory() const {
    return sizeof *this + patches.memory() + shallowFaces.capacity() * sizeof(int) + graph.memory() +
           patchNear.memory() + vertexNear.memory();
  }
};

}  // namespace fcl_stpbv::detail
