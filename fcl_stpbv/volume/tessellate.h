// Triangles for looking at a volume.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {

/// Triangles, counter-clockwise seen from outside. Points in m, the volume's frame.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;      ///< m
  std::vector<std::array<int, 3>> triangles;  ///< indices into `vertices`
};

/// Closed mesh of points on the surface, each patch cut so that normals turn by at most about
/// `angle` (rad, 0.02 to 1) from one point to the next. Corners shared by patches are shared
/// vertices. One point without a margin has no triangles. @throws Error for another angle.
TriangleMesh tessellate(const StpBv& volume, double angle = 0.2);

}  // namespace fcl_stpbv
