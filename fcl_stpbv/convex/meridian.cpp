// Penetration depth of two bodies of revolution with parallel axes. The shortest separating translation lies
// in a plane along the axes, so the problem becomes two-dimensional. This file finds that plane.
#include "fcl_stpbv/convex/meridian.h"

#include <optional>

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

/// The axis of a core of revolution through its frame's origin. A point may have any axis.
std::optional<Vector3d> axisOf(const Shape& s) {
  switch (s.kind) {
    case ShapeKind::point:
    case ShapeKind::segment:
    case ShapeKind::cylinder:
    case ShapeKind::cone:
      return Vector3d::UnitZ();
    case ShapeKind::ellipsoid:
      if (s.size.x() == s.size.y()) return Vector3d::UnitZ();
      if (s.size.x() == s.size.z()) return Vector3d::UnitY();
      if (s.size.y() == s.size.z()) return Vector3d::UnitX();
      return {};
    default:
      return {};
  }
}

}  // namespace

bool commonMeridian(const Shape& a, const Shape& b, const RelativePose& pose, Meridian& plane) {
  const std::optional<Vector3d> axisA = axisOf(a), axisB = axisOf(b);
  if (!axisA || !axisB || b.kind == ShapeKind::point) return false;
  plane.along = (pose.rotation * *axisB).normalized();
  const Vector3d translation = unpack(pose.translation);
  const Vector3d aside = translation - translation.dot(plane.along) * plane.along;
  plane.across =
      aside.cross(plane.along).cross(plane.along).normalized();  // twice, to remove rounding along the axis
  if (!(plane.across.norm() > 0.5)) plane.across = plane.along.unitOrthogonal();
  plane.outB = plane.along.cross(plane.across);
  plane.outA = a.kind == ShapeKind::point ? plane.outB : axisA->cross(plane.across).normalized();
  // The difference of two bodies of revolution with parallel axes is a body of revolution. The shortest way
  // out of it lies in the plane through its axis and the origin. A is turned by `turn` to make the axes
  // parallel.
  const double turn = a.kind == ShapeKind::point ? 0.0 : axisA->cross(plane.along).norm();
  plane.slack = 1.001 * turn * (a.centre.norm() + a.reach);
  return turn < 0.01;
}

}  // namespace fcl_stpbv::detail
