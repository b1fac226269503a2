// Distance of triangles in long double, from the definition: corners to faces,
// edges to edges, edges through faces.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

namespace fcl_stpbv::test {

using PointL = Eigen::Matrix<long double, 3, 1>;
using TriangleL = std::array<PointL, 3>;

/// Distance of a point from a triangle (m).
long double referenceDistance(const PointL& p, const TriangleL& t);
/// Distance of two triangles, 0 if they meet (m).
long double referenceDistance(const TriangleL& a, const TriangleL& b);

TriangleL placed(const Eigen::Isometry3d& pose, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                 const Eigen::Vector3d& c);
/// The twelve triangles of a box around its own origin.
std::vector<TriangleL> boxTriangles(const Eigen::Isometry3d& pose, const Eigen::Vector3d& sides);

}  // namespace fcl_stpbv::test
