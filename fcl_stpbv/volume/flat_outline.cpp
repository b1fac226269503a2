// Andrew's monotone chain (1979) in the plane of the points, each within rounding of a side left out.
#include "fcl_stpbv/volume/flat_outline.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Coordinates in the plane of the points; nothing where there is none.
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

/// Adds one half of the outline to `ring`, from the first in `order` on without the last.
template <class Order>
void addHalf(const std::vector<Vector2d>& flat, const Order& order, double tolerance, Ring& ring) {
  const std::size_t start = ring.size();
  for (const int r : order) {
    while (ring.size() > start + 1) {
      const Vector2d& p = flat[at(ring[ring.size() - 2])];
      const Vector2d chord = flat[at(r)] - p;
      if (cross(flat[at(ring.back())] - p, chord) > tolerance * chord.norm()) break;
      ring.pop_back();
    }
    ring.push_back(r);
  }
  ring.pop_back();
}

}  // namespace

Ring flatOutline(const std::vector<Vector3d>& points) {
  const double tolerance = touchTolerance(points);
  const std::vector<Vector2d> flat = inPlane(points, tolerance);
  if (flat.empty()) return {};
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    const Vector2d &p = flat[at(i)], &q = flat[at(j)];
    return p.x() != q.x() ? p.x() < q.x() : p.y() < q.y();
  });
  // Half of what may be off: what a side leaves out may be beyond the next one.
  Ring ring;
  addHalf(flat, order, 0.5 * tolerance, ring);
  std::reverse(order.begin(), order.end());
  addHalf(flat, order, 0.5 * tolerance, ring);
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
