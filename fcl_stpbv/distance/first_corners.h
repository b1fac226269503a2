// Four corners of a convex body that is known by its furthest points alone, to begin a polytope with.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace fcl_stpbv {

/// Four points of the body that span a volume, each furthest along some direction. `furthest(m)` gives the
/// body's point furthest along `m`, as anything with a member `w`, the point itself. False where the body is
/// flat to `rounding` (m); it has then been asked along both normals of the flat.
template <typename Point, typename Furthest>
bool firstCorners(Furthest&& furthest, double rounding, std::array<Point, 4>& c) {
  using Eigen::Vector3d;
  c[0] = furthest(Vector3d(Vector3d::UnitX()));
  const auto widen = [&](const Vector3d& m, const auto& measure, Point& best) {
    for (const Vector3d& d : {m, Vector3d(-m)}) {
      const Point p = furthest(d);
      if (measure(p.w) > measure(best.w)) best = p;
    }
  };
  c[1] = c[0];
  const auto fromPoint = [&](const Vector3d& w) { return (w - c[0].w).norm(); };
  for (int i = 0; i < 3; ++i) widen(Vector3d::Unit(i), fromPoint, c[1]);
  if (!(fromPoint(c[1].w) > rounding)) return false;
  const Vector3d u = (c[1].w - c[0].w).normalized(), e = u.unitOrthogonal();
  c[2] = c[0];
  const auto fromLine = [&](const Vector3d& w) { return u.cross(w - c[0].w).norm(); };
  widen(e, fromLine, c[2]);
  widen(u.cross(e), fromLine, c[2]);
  if (!(fromLine(c[2].w) > rounding)) return false;
  const Vector3d n = u.cross(c[2].w - c[0].w).normalized();
  c[3] = c[0];
  const auto fromPlane = [&](const Vector3d& w) { return std::abs(n.dot(w - c[0].w)); };
  widen(n, fromPlane, c[3]);
  return fromPlane(c[3].w) > rounding;
}

}  // namespace fcl_stpbv
