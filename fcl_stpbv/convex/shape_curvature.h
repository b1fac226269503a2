// The supporting feature of a simple shape along a normal, and how the normal may turn while that feature
// stays the supporting one.
#pragma once

#include <Eigen/Core>
#include <array>

#include "fcl_stpbv/convex/shape.h"

namespace fcl_stpbv::detail {

/// The normals of a feature near a given one: a face has one normal; an edge or a generator has a circle of
/// normals; a corner, a rim or a round surface has all normals nearby. Frame and units of the shape.
struct NormalCone {
  int count = 0;                       ///< number of directions in which the normal can turn: 0, 1 or 2
  Eigen::Vector3d normal;              ///< unit normal of the feature nearest to the given one
  std::array<Eigen::Vector3d, 2> way;  ///< unit, across the normal and each other
  /// Radii of curvature, the derivative of the surface point with the normal, along and between the ways (m).
  std::array<double, 2> along;
  double between;
};

/// The normals and the curvature of the feature with the outward unit normal `m`, at the point `x` of the
/// surface. If two features have that normal up to `rounding` (m), the flatter one is taken. False if the
/// curvature is not finite, such as at the rim of an ellipsoid without thickness, and if no normal of the
/// feature is near `m`.
bool normalCone(const Shape& shape, const Eigen::Vector3d& m, const Eigen::Vector3d& x, double rounding,
                NormalCone& result);

}  // namespace fcl_stpbv::detail
