// Distance from a mesh and the winding number about a point, by looking at every triangle in long double.
#pragma once

#include <Eigen/Core>

#include "fcl_stpbv/volume/tessellate.h"

namespace fcl_stpbv::test {

/// Distance of a point from the triangles (m).
double referenceDistance(const TriangleMesh& mesh, const Eigen::Vector3d& p);

/// Solid angle of the triangles seen from `p` divided by 4 pi. For a closed mesh it is a whole number, and
/// not 0 inside.
double referenceWinding(const TriangleMesh& mesh, const Eigen::Vector3d& p);

/// 0 if the winding number is not 0, otherwise the distance (m).
double referenceSolidDistance(const TriangleMesh& mesh, const Eigen::Vector3d& p);

}  // namespace fcl_stpbv::test
