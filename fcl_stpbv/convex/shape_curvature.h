// The feature of a simple shape that faces a body: how its normal may turn while it stays the one.
#pragma once

#include <Eigen/Core>
#include <array>

#include "fcl_stpbv/convex/shape.h"

namespace fcl_stpbv::detail {

/// The normals that a face (one), an edge or a generator (a circle), a corner, a rim or a round surface (all
/// near) can have, next to one of them. Frame and units of the shape.
struct NormalCone {
  int count = 0;                       ///< ways to turn: 0, 1 or 2
  Eigen::Vector3d normal;              ///< unit, the one of them next to what was asked about
  std::array<Eigen::Vector3d, 2> way;  ///< unit, across the normal and each other
  /// Radii of curvature, the derivative of the surface point with the normal, along and between the ways (m).
  std::array<double, 2> along;
  double between;
};

/// What the shape shows along its outward unit normal `m`, at the point `x` of its surface. Two features that
/// both have the normal, to `rounding` (m), are taken for the flatter one. False where the curvature is not
/// finite, as at the rim of an ellipsoid without thickness, and where no normal of that feature is near `m`.
bool normalCone(const Shape& shape, const Eigen::Vector3d& m, const Eigen::Vector3d& x, double rounding,
                NormalCone& result);

}  // namespace fcl_stpbv::detail
