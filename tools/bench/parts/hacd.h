// The method that the parts are compared with: HACD, hierarchical approximate convex decomposition (Mamou and
// Ghorbel, ICIP 2009), from Bullet's extras. Its partition of the triangles is used with the hulls of the
// clusters, because HACD's own hulls leave triangles uncovered.
#pragma once

#include <vector>

#include "fcl_stpbv/volume/tessellate.h"

namespace fcl_stpbv::benchmark {

/// The points of each cluster of triangles: `count` clusters if HACD finds so few.
std::vector<std::vector<Eigen::Vector3d>> hacdClusters(const TriangleMesh& mesh, int count);

}  // namespace fcl_stpbv::benchmark
