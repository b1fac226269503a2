// Support functions of the simple shapes, each in closed form (Ericson, Real-Time Collision Detection, 9.5):
// a core (point, segment, box, disc, ...) plus a ball of radius `margin`.
#include "fcl_stpbv/convex/shape.h"

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/convex/vertex_cap.h"
#include "fcl_stpbv/convex/vertex_set.h"

namespace fcl_stpbv {

using Eigen::Vector3d;

namespace {

/// Whether a vector is accepted as the unit normal of a plane. FCL normalises its planes; other lengths are
/// invalid.
bool isUnitNormal(const Vector3d& normal) { return std::abs(normal.squaredNorm() - 1.0) < 1e-6; }

/// Length of `d` across the z axis. Faster than std::hypot(), which is used only if squares would underflow
/// or overflow.
double acrossAxis(const Vector3d& d) {
  constexpr double kLeast = 1e-280, kMost = 1e280;
  const double squared = d.x() * d.x() + d.y() * d.y();
  return squared > kLeast && squared < kMost ? std::sqrt(squared) : std::hypot(d.x(), d.y());
}

}  // namespace

Shape Shape::sphere(double radius) {
  Shape s;
  s.margin = radius;
  return s;
}

Shape Shape::capsule(double radius, double length) {
  Shape s;
  s.kind = ShapeKind::segment;
  s.margin = radius;
  s.half = s.reach = 0.5 * length;
  return s;
}

Shape Shape::boxOf(const Vector3d& sides) {
  Shape s;
  s.kind = ShapeKind::box;
  s.size = 0.5 * sides;
  s.reach = s.size.norm();
  return s;
}

Shape Shape::triangleOf(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  Shape s;
  s.kind = ShapeKind::triangle;
  s.corner = {a, b, c};
  s.centre = (a + b + c) / 3.0;
  for (const Vector3d& p : s.corner) s.reach = std::max(s.reach, (p - s.centre).norm());
  return s;
}

Shape Shape::polytopeOf(const Vector3d* vertices, int count, const Vector3d& middle) {
  constexpr double kSame = 1e-12;  // of the reach: two means that were summed in different orders
  Shape s;
  s.kind = ShapeKind::polytope;
  s.vertices = vertices;
  s.vertexCount = count;
  if (count < 1) return s;
  const detail::Spread all = detail::spreadAbout(middle, vertices, count);
  const double off = (all.middle - middle).norm();
  s.centre = all.middle;
  const bool same = off < kSame * all.reach;  // false for infinite ones
  s.reach = same ? all.reach + off : detail::spreadAbout(all.middle, vertices, count).reach;
  return s;
}

Shape Shape::cylinderOf(double radius, double length) {
  Shape s;
  s.kind = ShapeKind::cylinder;
  s.radius = radius;
  s.half = 0.5 * length;
  s.reach = std::hypot(s.radius, s.half);
  return s;
}

Shape Shape::coneOf(double radius, double length) {
  Shape s = cylinderOf(radius, length);
  s.kind = ShapeKind::cone;
  return s;
}

Shape Shape::ellipsoidOf(const Vector3d& semiAxes) {
  Shape s;
  s.kind = ShapeKind::ellipsoid;
  s.size = semiAxes;
  s.reach = semiAxes.maxCoeff();
  return s;
}

Shape Shape::halfspaceOf(const Vector3d& normal, double offset) {
  Shape s;
  s.kind = ShapeKind::halfspace;
  // The normal's length may be off by 1e-6. Without this division the plane would move by that fraction of
  // the offset.
  const double length = isUnitNormal(normal) ? normal.norm() : 1.0;
  s.normal = normal / length;
  s.offset = offset / length;
  s.centre = s.offset * s.normal;
  return s;
}

Shape Shape::planeOf(const Vector3d& normal, double offset) {
  Shape s = halfspaceOf(normal, offset);
  s.kind = ShapeKind::plane;
  return s;
}

bool Shape::valid() const {
  if (unbounded()) return isUnitNormal(normal) && std::isfinite(offset);
  if (kind == ShapeKind::polytope && vertexCount < 1) return false;
  const double all = margin + radius + half + reach + size.sum() + centre.sum();
  return std::isfinite(all) && margin >= 0.0 && radius >= 0.0 && half >= 0.0 && size.minCoeff() >= 0.0;
}

Vector3d Shape::support(const Vector3d& d) const {
  const auto rim = [&](double z) -> Vector3d {
    const double across = acrossAxis(d);
    if (!(across > 0.0)) return {radius, 0.0, z};
    return {radius * (d.x() / across), radius * (d.y() / across), z};
  };
  switch (kind) {
    case ShapeKind::segment:
      return {0.0, 0.0, std::copysign(half, d.z())};
    case ShapeKind::box:
      return {std::copysign(size.x(), d.x()), std::copysign(size.y(), d.y()), std::copysign(size.z(), d.z())};
    case ShapeKind::triangle: {
      const double a = d.dot(corner[0]), b = d.dot(corner[1]), c = d.dot(corner[2]);
      return corner[a >= b ? (a >= c ? 0 : 2) : (b >= c ? 1 : 2)];
    }
    case ShapeKind::polytope:
      if (cap) return cap->furthest(d, vertices, vertexCount);
      return vertices[detail::furthestAlong(d, vertices, vertexCount)];
    case ShapeKind::cylinder:
      return rim(std::copysign(half, d.z()));
    case ShapeKind::cone: {
      const double apex = 2.0 * half * d.z(), side = radius * acrossAxis(d);
      return apex > side ? Vector3d(0.0, 0.0, half) : rim(-half);
    }
    case ShapeKind::ellipsoid: {
      const double h = size.cwiseProduct(d).norm();
      if (!(h > 0.0)) return {0.0, 0.0, 0.0};
      return size.cwiseProduct(size).cwiseProduct(d) / h;
    }
    case ShapeKind::point:
    case ShapeKind::halfspace:
    case ShapeKind::plane:
      break;
  }
  return {0.0, 0.0, 0.0};
}

}  // namespace fcl_stpbv
