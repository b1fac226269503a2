// What a query reads of a volume: made once, when the volume is built.
#pragma once

#include "fcl_stpbv/volume/direction_table.h"
#include "fcl_stpbv/volume/patch_table.h"
#include "fcl_stpbv/volume/vertex_graph.h"

namespace fcl_stpbv::detail {

struct QueryTables {
  PatchTable patches;         ///< with the boundaries of their regions of normals
  VertexGraph graph;          ///< the way from vertex to vertex
  DirectionTable patchNear;   ///< the patch that owns the middle of each cell of directions
  DirectionTable vertexNear;  ///< the vertex furthest along that middle

  /// Memory they hold, in bytes.
  std::size_t memory() const {
    return sizeof *this + patches.memory() + graph.memory() + patchNear.memory() + vertexNear.memory();
  }
};

}  // namespace fcl_stpbv::detail
