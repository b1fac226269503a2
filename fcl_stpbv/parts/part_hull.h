// Fast convex hulls of parts, for the search.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fcl_stpbv/parts/mesh_solid.h"

namespace fcl_stpbv::detail {

struct PartHull {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> surface;
  double volume = 0;  ///< 0 for a flat hull (m^3)
  /// Diagonal of the box around it (m).
  double diagonal() const;
};

/// The hull up to rounding of the coordinates, by quickhull; for flat clouds by the rolling ball.
PartHull partHull(const std::vector<Eigen::Vector3d>& points);

}  // namespace fcl_stpbv::detail
