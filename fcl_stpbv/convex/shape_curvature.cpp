// The normals of a shape's supporting feature, and its curvature, in closed form. The supporting feature is
// what lies furthest along the normal: a face, an edge or a corner of a polytope; the rim, a generator or the
// disc of a cylinder or cone; a ball; a point of an ellipsoid.
#include "fcl_stpbv/convex/shape_curvature.h"

#include <Eigen/Geometry>
#include <cmath>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

namespace {

const Vector3d kNone(0, 0, 0);

/// The normals perpendicular to a line along `t`, of a surface with the radius of curvature `radius` around
/// it. Zero if the line is parallel to `m`.
NormalCone aroundLine(const Vector3d& m, const Vector3d& t, double radius) {
  constexpr double kAlong = 1e-3;
  const Vector3d across = m - m.dot(t) * t;
  if (!(across.norm() > kAlong)) return {1, kNone, {kNone, kNone}, {radius, 0.0}, 0.0};
  return {1, across.normalized(), {t.cross(m).normalized(), kNone}, {radius, 0.0}, 0.0};
}

/// The cone of a flat face, on the side to which `m` points.
NormalCone noWay(const Vector3d& m, const Vector3d& face) {
  return {0, m.dot(face) < 0.0 ? Vector3d(-face) : face, {kNone, kNone}, {0.0, 0.0}, 0.0};
}

/// The cone of a point: all normals near `m`.
NormalCone allAround(const Vector3d& m) {
  const Vector3d e = m.unitOrthogonal();
  return {2, m, {e, m.cross(e)}, {0.0, 0.0}, 0.0};
}

NormalCone ofSegment(const Vector3d& m, double half, double rounding) {
  return half * std::abs(m.z()) > rounding || !(half > 0.0) ? allAround(m)
                                                            : aroundLine(m, Vector3d::UnitZ(), 0.0);
}

/// The cone of a face, an edge or a corner: all vertices that are as high along `m` as `a`.
template <typename Vertex>
NormalCone ofVertices(int count, const Vertex& vertex, const Vector3d& a, const Vector3d& m,
                      double rounding) {
  const double most = m.dot(a);
  const auto furthest = [&](const auto& measure, Vector3d& best) {
    double length = rounding;
    for (int i = 0; i < count; ++i) {
      const Vector3d p = vertex(i);
      if (most - m.dot(p) > rounding || !(measure(p) > length)) continue;
      length = measure(p);
      best = p;
    }
    return length > rounding;
  };
  Vector3d b = a;
  if (!furthest([&](const Vector3d& p) { return (p - a).norm(); }, b)) return allAround(m);
  const Vector3d t = (b - a).normalized();
  Vector3d c = a;
  if (!furthest([&](const Vector3d& p) { return t.cross(p - a).norm(); }, c)) return aroundLine(m, t, 0.0);
  return noWay(m, t.cross(c - a).normalized());
}

/// The cone of a box's corner, edge or face. An edge counts if both of its ends are equally high along `m`.
NormalCone ofBox(const Vector3d& half, const Vector3d& m, double rounding) {
  const auto isLevel = [&](int i) {
    const double side = 2.0 * half[i];
    return side * std::abs(m[i]) <= rounding && side > rounding;
  };
  int steepest, count = 0, along = 0;  // axes
  m.cwiseAbs().maxCoeff(&steepest);
  for (int i = 0; i < 3; ++i)
    if (i != steepest && isLevel(i)) ++count, along = i;
  if (count == 0) return allAround(m);
  return count == 1 ? aroundLine(m, Vector3d::Unit(along), 0.0) : noWay(m, Vector3d::Unit(steepest));
}

/// A disc's rim: a circle of this radius around z. If the normal is near the axis, it does not determine the
/// position on the rim, so the point `x` is used.
NormalCone ofRim(const Vector3d& m, const Vector3d& x, double radius, double across) {
  const Vector3d out(x.x(), x.y(), 0.0);
  Vector3d around = Vector3d::UnitZ().cross(out.norm() > 0.0 ? out : m);
  around = (around - around.dot(m) * m).normalized();
  return {2, m, {around, m.cross(around)}, {radius / across, 0.0}, 0.0};
}

NormalCone ofCylinder(const Shape& s, const Vector3d& m, const Vector3d& x, double rounding) {
  if (!(s.radius > 0.0)) return ofSegment(m, s.half, rounding);
  const double across = m.head<2>().norm();
  if (s.radius * across <= rounding) return noWay(m, Vector3d::UnitZ());
  if (s.half > 0.0 && s.half * std::abs(m.z()) <= rounding) return aroundLine(m, Vector3d::UnitZ(), s.radius);
  return ofRim(m, x, s.radius, across);
}

NormalCone ofCone(const Shape& s, const Vector3d& m, const Vector3d& x, double rounding) {
  if (!(s.radius > 0.0)) return ofSegment(m, s.half, rounding);
  const double across = m.head<2>().norm(), height = 2.0 * s.half;
  if (s.radius * across <= rounding && (m.z() < 0.0 || !(height > 0.0))) return noWay(m, Vector3d::UnitZ());
  const double towardsApex = m.z() * height - across * s.radius;
  if (towardsApex > rounding) return allAround(m);
  if (!(height > 0.0) || towardsApex < -rounding) return ofRim(m, x, s.radius, across);
  const Vector3d out = Vector3d(m.x(), m.y(), 0.0) / across, around = Vector3d::UnitZ().cross(out),
                 normal = (height * out + s.radius * Vector3d::UnitZ()).normalized();
  // The radius of curvature grows with the distance from the apex.
  const double down = (x - Vector3d(0, 0, s.half)).dot(around.cross(normal));
  return {1, normal, {around, kNone}, {down * s.radius / height, 0.0}, 0.0};
}

bool ofEllipsoid(const Shape& s, const Vector3d& m, NormalCone& result) {
  const Vector3d e = s.size.cwiseProduct(m);
  const double h = e.norm();
  if (!(h > 1e-9 * s.reach)) return false;
  result = allAround(m);
  // Perpendicular to the unit ball's point whose image is the ellipsoid's point: without cancellation.
  const auto across = [&](const Vector3d& t) {
    const Vector3d image = s.size.cwiseProduct(t);
    return Vector3d(image - image.dot(e) / h * (e / h));
  };
  const Vector3d t = across(result.way[0]), u = across(result.way[1]);
  result.along = {t.squaredNorm() / h, u.squaredNorm() / h};
  result.between = t.dot(u) / h;
  return true;
}

/// normalCone() of the core, without the margin.
bool coneOfCore(const Shape& s, const Vector3d& m, const Vector3d& x, double rounding, NormalCone& result) {
  switch (s.kind) {
    case ShapeKind::point:
      result = allAround(m);
      break;
    case ShapeKind::segment:
      result = ofSegment(m, s.half, rounding);
      break;
    case ShapeKind::box:
      result = ofBox(s.size, m, rounding);
      break;
    case ShapeKind::triangle:
      result = ofVertices(
          3, [&](int i) { return s.corner[at(i)]; }, s.support(m), m, rounding);
      break;
    case ShapeKind::polytope:
      result = ofVertices(
          s.vertexCount, [&](int i) { return s.vertices[i]; }, s.support(m), m, rounding);
      break;
    case ShapeKind::cylinder:
      result = ofCylinder(s, m, x, rounding);
      break;
    case ShapeKind::cone:
      result = ofCone(s, m, x, rounding);
      break;
    case ShapeKind::ellipsoid:
      return ofEllipsoid(s, m, result);
    case ShapeKind::halfspace:
    case ShapeKind::plane:
      result = noWay(m, s.normal);
      break;
  }
  return result.normal.squaredNorm() > 0.5;  // false for a line along `m`
}

}  // namespace

bool normalCone(const Shape& s, const Vector3d& m, const Vector3d& x, double rounding, NormalCone& result) {
  if (!coneOfCore(s, m, x, rounding, result)) return false;
  for (std::size_t i = 0; i < static_cast<std::size_t>(result.count); ++i) result.along[i] += s.margin;
  return true;
}

}  // namespace fcl_stpbv::detail
