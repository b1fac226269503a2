// The segments, arcs and discs that a simple shape contains around one of its points, for the proof of a
// depth (local_maximum.h).
#pragma once

#include <Eigen/Core>

#include "fcl_stpbv/convex/local_maximum.h"
#include "fcl_stpbv/convex/shape.h"

namespace fcl_stpbv::detail {

/// Whether addShape() supports the shape. It does not support triangles and polytopes.
inline bool hasAround(const Shape& shape) {
  return shape.kind != ShapeKind::triangle && shape.kind != ShapeKind::polytope;
}

/// Adds the segments, arcs and discs through the point `y` of the shape's core that are perpendicular to its
/// outward normal `m` (unit; both in the shape's own frame), turned by `rotation`.
void addShape(const Shape& shape, const Eigen::Vector3d& y, const Eigen::Vector3d& m,
              const Eigen::Matrix3d& rotation, LocalMaximum& around);

}  // namespace fcl_stpbv::detail
