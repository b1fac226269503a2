// Penetration depth of two bodies of revolution with parallel axes. The shortest separating translation lies
// in a plane along the axes, so the problem becomes two-dimensional. This file finds that plane.
#include "fcl_stpbv/convex/meridian.h"

#include <optional>

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

/// The axis of a core of revolution in its own frame, through its origin; of a point, any.
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
      aside.cross(plane.along).cross(plane.along).normalized();  // nothing along the axis, not even rounding
  if (!(plane.across.norm() > 0.5)) plane.across = plane.along.unitOrthogonal();
  plane.outB = plane.along.cross(plane.across);
  plane.outA = a.kind == ShapeKind::point ? plane.outB : axisA->cross(plane.across).normalized();
  // Two bodies of revolution with parallel axes have a difference of revolution, and out of it the shortest
  // way lies in the plane through its axis and the origin. A is turned to make them parallel.
  const double turn = a.kind == ShapeKind::point ? 0.0 : axisA->cross(plane.along).norm();
  plane.slack = 1.001 * turn * (a.centre.norm() + a.reach);
  return turn < 0.01;
}

}  // namespace fcl_stpbv::detail
