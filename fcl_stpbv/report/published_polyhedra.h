// Compares a robot's volumes with those of polyhedra that were published for the same meshes.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/robot/link_geometry.h"

namespace fcl_stpbv::report {

/// A mesh's volume and that of its polyhedron, both of all points and with the same radii.
struct PolyhedronReport {
  std::string file;  ///< "" where the folder has none for the mesh
  int meshVertices = 0, vertices = 0;
  int meshAlone = 0, alone = 0;  ///< vertices of one without any of the other within 1 um
  double difference = 0;         ///< surfaceDifference() (m)
};

/// One report a body. `MESH-ch.txt` or `MESH.otp` in the folder belongs to MESH.stl, MESH.dae, ...;
/// coordinates are in metres, in the mesh's frame.
/// @throws Error where `folder` is none or holds a polyhedron for no mesh.
std::vector<PolyhedronReport> comparePolyhedra(const RobotGeometry& geometry, const std::string& folder);

}  // namespace fcl_stpbv::report
