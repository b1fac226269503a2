// Compares a robot's volumes with those of polyhedra that were published for the same meshes.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/robot/link_geometry.h"

namespace fcl_stpbv::report {

/// Comparison of a mesh's volume with that of its polyhedron. Both are built from all points, with the same
/// radii.
struct PolyhedronReport {
  std::string file;  ///< "" if the folder has none for the mesh
  int meshVertices = 0, vertices = 0;
  int meshAlone = 0, alone = 0;  ///< number of vertices of one without any of the other within 1 um
  double difference = 0;         ///< surfaceDifference() of the two volumes (m)
};

/// One report for each body. `MESH-ch.txt` or `MESH.otp` in the folder belongs to MESH.stl, MESH.dae, ...;
/// coordinates are in metres, in the mesh's frame.
/// @throws Error if `folder` is no folder or contains a polyhedron for no mesh.
std::vector<PolyhedronReport> comparePolyhedra(const RobotGeometry& geometry, const std::string& folder);

}  // namespace fcl_stpbv::report
