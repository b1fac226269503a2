// Triangle meshes of a volume, for viewing.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {

/// A triangle mesh. The corners of each triangle are counter-clockwise seen from outside. tessellate() gives
/// points in the volume's frame.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;      ///< m
  std::vector<std::array<int, 3>> triangles;  ///< indices into `vertices`
};

/// Closed mesh whose vertices lie on the surface. Each patch is divided so that the normal turns by at most
/// about `angle` (rad, 0.02 to 1) from one vertex to the next. Patches share vertices along their common
/// boundaries. The volume of one point with r = 0 has no triangles. @throws Error if `angle` is out of range.
TriangleMesh tessellate(const StpBv& volume, double angle = 0.2);

}  // namespace fcl_stpbv
