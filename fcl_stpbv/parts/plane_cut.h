// Triangles cut in two by a plane.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace fcl_stpbv::detail {

struct CutPlane {
  Eigen::Vector3d normal{0, 0, 1};  ///< unit vector
  double offset = 0;                ///< the plane is normal.x = offset (m)
  double height(const Eigen::Vector3d& p) const { return normal.dot(p) - offset; }
  CutPlane turned() const { return {-normal, -offset}; }
};

/// Triangles of one group of a mesh's pieces, or what remains of them after cuts.
struct TriangleSoup {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> facet;  ///< index of the mesh's flat part of each triangle
};

/// The part of the soup on the side that the normal points to. Corners within `slack` (m) of the plane count
/// as on it. A triangle in the plane belongs to the side from which its normal points away, where a solid
/// would be. A degenerate triangle there belongs to one of the two sides. Both sides together contain the
/// whole soup.
TriangleSoup above(const TriangleSoup& soup, const CutPlane& plane, double slack);

/// Only the points of above(), in less time.
void pointsAbove(const TriangleSoup& soup, const CutPlane& plane, double slack,
                 std::vector<Eigen::Vector3d>& points);

}  // namespace fcl_stpbv::detail
