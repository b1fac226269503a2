// The peer of the parts: HACD, hierarchical approximate convex decomposition (Mamou and Ghorbel,
// ICIP 2009), as Bullet's extras have it. Its partition of the triangles is used, and the hulls of
// that: its own hulls leave triangles uncovered.
#pragma once

#include <vector>

#include "fcl_stpbv/volume/tessellate.h"

namespace fcl_stpbv::benchmark {

/// The points of each cluster of triangles, `count` clusters where HACD finds so few.
std::vector<std::vector<Eigen::Vector3d>> hacdClusters(const TriangleMesh& mesh, int count);

}  // namespace fcl_stpbv::benchmark
