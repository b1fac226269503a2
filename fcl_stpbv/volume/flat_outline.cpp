// The convex polygon around points in a plane. Points within rounding of a side are no corners.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/ball_faces.h"
#include "fcl_stpbv/volume/convex_polygon.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Coordinates of the points in their common plane; empty if they have no common plane or lie on one line.
std::vector<Vector2d> inPlane(const std::vector<Vector3d>& points, double tolerance) {
  const auto farthest = [&](const auto& measure) -> const Vector3d& {
    return *std::max_element(points.begin(), points.end(),
                             [&](const Vector3d& p, const Vector3d& q) { return measure(p) < measure(q); });
  };
  const Vector3d& a = farthest([&](const Vector3d& p) { return (p - points[0]).squaredNorm(); });
  const Vector3d& b = farthest([&](const Vector3d& p) { return (p - a).squaredNorm(); });
  const Vector3d x = (b - a).normalized();
  const Vector3d& c = farthest([&](const Vector3d& p) { return x.cross(p - a).squaredNorm(); });
  const Vector3d across = x.cross(c - a);
  if (!(across.norm() > tolerance)) return {};
  const Vector3d normal = across.normalized(), y = normal.cross(x);
  std::vector<Vector2d> flat;
  flat.reserve(points.size());
  for (const Vector3d& p : points) {
    if (!(std::abs(normal.dot(p - a)) <= tolerance)) return {};
    flat.emplace_back(x.dot(p - a), y.dot(p - a));
  }
  return flat;
}

}  // namespace

Ring flatOutline(const std::vector<Vector3d>& points) {
  const double tolerance = touchTolerance(points);
  const std::vector<Vector2d> flat = inPlane(points, tolerance);
  if (flat.empty()) return {};
  // Half of the tolerance: a corner that is left out within this distance of one chord may be farther outside
  // a later one.
  const Ring ring = convexPolygon(flat, 0.5 * tolerance);
  if (ring.size() < 3) return {};
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vector2d& p = flat[at(ring[k])];
    const Vector2d side = flat[at(ring[(k + 1) % ring.size()])] - p;
    for (const Vector2d& q : flat)
      if (!(cross(side, q - p) >= -tolerance * side.norm())) return {};
  }
  return ring;
}

}  // namespace fcl_stpbv::detail
