// Projects a point onto the core of a simple shape, to correct errors of rounding or of a search.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>

#include "fcl_stpbv/convex/shape.h"

namespace fcl_stpbv::detail {

/// A point of the core near `y`; the nearest one to first order. Frame and units of the shape.
Eigen::Vector3d ontoCore(const Shape& core, const Eigen::Vector3d& y);

/// The segment's point nearest to `y`. Its ends may coincide.
inline Eigen::Vector3d ontoSegment(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                   const Eigen::Vector3d& y) {
  const Eigen::Vector3d along = b - a;
  const double length2 = along.squaredNorm();
  if (!(length2 > 0)) return a;
  return a + std::clamp((y - a).dot(along) / length2, 0.0, 1.0) * along;
}

/// The triangle's point nearest to `y`; the triangle may be a sliver, a segment or a point.
Eigen::Vector3d ontoTriangle(const std::array<Eigen::Vector3d, 3>& corner, const Eigen::Vector3d& y);

}  // namespace fcl_stpbv::detail
