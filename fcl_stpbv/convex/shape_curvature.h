// The supporting feature of a simple shape along a normal, and how the normal may turn while that feature
// stays the supporting one. And the segments, arcs and discs that the shape contains around one of its
// points, for the proof of a depth (local_maximum.h).
#pragma once

#include <Eigen/Core>
#include <array>

#include "fcl_stpbv/convex/local_maximum.h"
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

/// Whether addShape() supports the shape. It does not support triangles and polytopes.
inline bool hasAround(const Shape& shape) {
  return shape.kind != ShapeKind::triangle && shape.kind != ShapeKind::polytope;
}

/// Adds the segments, arcs and discs through the point `y` of the shape's core that are perpendicular to its
/// outward normal `m` (unit; both in the shape's own frame), turned by `rotation`.
void addShape(const Shape& shape, const Eigen::Vector3d& y, const Eigen::Vector3d& m,
              const Eigen::Matrix3d& rotation, LocalMaximum& around);

}  // namespace fcl_stpbv::detail
