// What a query reads of a volume: made once, when the volume is built.
#pragma once

#include <limits>
#include <vector>

#include "fcl_stpbv/volume/body_box.h"
#include "fcl_stpbv/volume/direction_table.h"
#include "fcl_stpbv/volume/patch_table.h"
#include "fcl_stpbv/volume/vertex_graph.h"

namespace fcl_stpbv::detail {

struct QueryTables {
  /// A bound on how far the support function is off the points' own, beyond its rounding: surface_check.h
  /// (m). Set by the builder once it has looked at what it made, before anyone else sees it.
  mutable double supportError = 0;
  PatchTable patches;  ///< with the boundaries of their regions of normals
  /// Faces near the centre, nearest first, each the nearest of those about its direction: along their normals
  /// the body is likely to be left soonest.
  std::vector<int> shallowFaces;
  double capHeight = std::numeric_limits<double>::infinity();  ///< point_depth.h (m)
  BodyBox box;
  VertexGraph graph;          ///< the way from vertex to vertex
  DirectionTable patchNear;   ///< the patch that owns the middle of each cell of directions
  DirectionTable vertexNear;  ///< the vertex furthest along that middle

  /// Memory they hold, in bytes.
  std::size_t memory() const {
    return sizeof *this + patches.memory() + shallowFaces.capacity() * sizeof(int) + graph.memory() +
           patchNear.memory() + vertexNear.memory();
  }
};

}  // namespace fcl_stpbv::detail
