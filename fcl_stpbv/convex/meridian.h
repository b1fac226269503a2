// Penetration depth of bodies of revolution with parallel axes, reduced to a problem in a plane along the
// axes.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/convex/shape.h"

namespace fcl_stpbv::detail {

/// A plane through the origin that contains the point of the boundary of the difference B - A nearest to the
/// origin.
struct Meridian {
  Eigen::Vector3d along, across;  ///< unit and orthogonal, in A's frame
  Eigen::Vector3d outA, outB;     ///< unit normals of the planes through each body's own axis
  /// Upper bound on the distance of the cores from two cores with exactly parallel axes (m).
  double slack;
};

/// The meridian plane of two cores of revolution, with their axes taken as parallel, or of a point (A) and a
/// core of revolution. False for any other pair, and if the axes are not nearly parallel.
bool commonMeridian(const Shape& a, const Shape& b, const RelativePose& pose, Meridian& plane);

/// The point of a polygon's boundary nearest to the origin. The polygon lies inside the difference.
struct MeridianDepth {
  bool found = false;            ///< the polygon has an area
  double depth = 0;              ///< lower bound on the depth of the origin inside the difference (m)
  Eigen::Vector3d onA{0, 0, 0};  ///< A's part of that point
  Eigen::Vector3d toB{0, 0, 0};  ///< from there to B's part (m)
};

/// Two-dimensional EPA: grows a polygon in the meridian plane at its side nearest to the origin, until it
/// reaches the boundary there. `furthest(m)` returns the support point of the difference along `m`: `.w`, and
/// A's part of it, `.onA`.
template <typename Furthest>
MeridianDepth meridianDepth(const Meridian& plane, double rounding, Furthest&& furthest) {
  constexpr std::size_t kPoints = 200;  // each one halves an arc: enough to reach rounding
  struct Point {
    Eigen::Vector2d w;
    Eigen::Vector3d onA, toB;
  };
  std::array<Point, kPoints> point;  // counter-clockwise
  const auto along = [&](const Eigen::Vector2d& m) {
    const auto p = furthest(m.x() * plane.along + m.y() * plane.across);
    // The projection of a point of a body of revolution onto a plane through its axis is in the body. For a
    // disc, furthest() may return any point of the rim.
    const Eigen::Vector3d onB = p.onA + p.w, onA = p.onA - plane.outA.dot(p.onA) * plane.outA;
    return Point{
        {plane.along.dot(p.w), plane.across.dot(p.w)}, onA, onB - plane.outB.dot(onB) * plane.outB - onA};
  };
  std::size_t points = 0;
  for (const Eigen::Vector2d& m :
       {Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1), Eigen::Vector2d(-1, 0), Eigen::Vector2d(0, -1)}) {
    const Point next = along(m);
    if (points == 0 ||
        ((next.w - point[points - 1].w).norm() > rounding && (next.w - point[0].w).norm() > rounding))
      point[points++] = next;
  }
  MeridianDepth result;
  while (points > 2) {
    std::size_t nearest = 0;
    double depth = 0;
    Eigen::Vector2d normal(0, 0);
    for (std::size_t i = 0; i < points; ++i) {
      const Eigen::Vector2d side = point[(i + 1) % points].w - point[i].w, n(side.y(), -side.x());
      const double height = n.dot(point[i].w) / n.norm();
      if (i > 0 && !(height < depth)) continue;
      nearest = i, depth = height, normal = n.normalized();
    }
    const Point &p = point[nearest], &q = point[(nearest + 1) % points];
    result.found = true;
    result.depth = depth - 2 * plane.slack;
    const Eigen::Vector2d side = q.w - p.w;
    const double part = std::min(1.0, std::max(0.0, -p.w.dot(side) / side.squaredNorm()));
    result.onA = p.onA + part * (q.onA - p.onA);
    result.toB = p.toB + part * (q.toB - p.toB);
    if (points == kPoints) break;
    const Point next = along(normal);
    if (!(normal.dot(next.w) - depth > 0.25 * rounding)) break;
    for (std::size_t i = points++; i > nearest + 1; --i) point[i] = point[i - 1];
    point[nearest + 1] = next;
  }
  return result;
}

}  // namespace fcl_stpbv::detail
