// Removes points that are well inside the cloud, in one pass:
// 1. make the convex hull of some points; it lies inside the hull of all points;
// 2. lay a grid of cells over the cloud. If all corners of a cell are inside that hull, the cell and its
//    points are. These points are removed. The hull's own corners are in none of these cells and stay, so any
//    convex body that contains the remaining points contains all.
#include "fcl_stpbv/volume/outer_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/ball_faces.h"
#include "fcl_stpbv/volume/rolling_ball.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

// Clouds of up to this size keep all points: the removal would take longer than it saves.
constexpr std::size_t kFew = 10000;
// Number of points for the hull. The hull of 3000 points spread through a body lacks a few percent of its
// volume.
constexpr std::size_t kSome = 3000;

struct Plane {
  Vector3d normal;
  double offset;
};

// Planes around a body that lies inside the points' hull by `margin`. Empty if many points are vertices, as
// on a surface, or if a face's triangle is too thin.
std::vector<Plane> bodyInside(const std::vector<Vector3d>& points, double margin) {
  std::vector<Vector3d> some;
  for (std::size_t k = 0; k < kSome; ++k) some.push_back(points[k * points.size() / kSome]);
  RolledHull hull;
  try {
    hull = quickBallHull(some, flatRadius(some));
  } catch (const Error&) {
    return {};
  }
  if (hull.faces.size() > kSome / 2) return {};  // then at least a quarter of the points are vertices
  std::vector<Plane> planes;
  for (const Ring& ring : hull.faces) {
    const std::array<int, 3> t = wideTriangle(some, ring);
    const Vector3d& a = some[at(t[0])];
    const Vector3d u = some[at(t[1])] - a, v = some[at(t[2])] - a, n = u.cross(v);
    constexpr double kThin = 1e-6;  // the plane of a thinner triangle may be off by as much as the margin
    if (!(n.norm() > kThin * u.norm() * v.norm())) return {};
    planes.push_back({n.normalized(), n.normalized().dot(a) - margin});
  }
  return planes;
}

// Cells over the cloud's bounding box.
struct Grid {
  Vector3d low, cell;
  int side;

  std::size_t index(int i, int j, int k, int across) const {
    return static_cast<std::size_t>((i * across + j) * across + k);
  }
  std::size_t cellOf(const Vector3d& p) const {
    const Vector3d at = (p - low).cwiseQuotient(cell);
    const auto slot = [&](double x) { return std::clamp(static_cast<int>(x), 0, side - 1); };
    return index(slot(at.x()), slot(at.y()), slot(at.z()), side);
  }
};

// For each cell: whether all its corners are below all planes.
std::vector<char> cellsInside(const Grid& grid, const std::vector<Plane>& planes) {
  const int side = grid.side, corners = side + 1;
  std::vector<char> corner;
  corner.reserve(static_cast<std::size_t>(corners * corners * corners));
  // The previous corner outside was above this plane, so the next one is likely above it, too.
  std::size_t last = 0;
  for (int i = 0; i < corners; ++i)
    for (int j = 0; j < corners; ++j)
      for (int k = 0; k < corners; ++k) {
        const Vector3d p = grid.low + Vector3d(i, j, k).cwiseProduct(grid.cell);
        const auto isBelow = [&](const Plane& plane) { return plane.normal.dot(p) <= plane.offset; };
        bool isInside = isBelow(planes[last]);
        for (std::size_t f = 0; f < planes.size() && isInside; ++f)
          if (!isBelow(planes[f])) isInside = false, last = f;
        corner.push_back(isInside);
      }
  std::vector<char> inside;
  inside.reserve(static_cast<std::size_t>(side * side * side));
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      for (int k = 0; k < side; ++k) {
        bool all = true;
        for (const int c : {0, 1, 2, 3, 4, 5, 6, 7})
          all = all && corner[grid.index(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2), corners)];
        inside.push_back(all);
      }
  return inside;
}

}  // namespace

std::vector<int> outerPoints(const std::vector<Vector3d>& points) {
  std::vector<int> outer(points.size());
  std::iota(outer.begin(), outer.end(), 0);
  if (points.size() <= kFew) return outer;
  Vector3d low = points[0], high = points[0];
  for (const Vector3d& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const double size = std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
  const std::vector<Plane> planes = bodyInside(points, 1e-6 * size);
  if (planes.empty()) return outer;
  // About eight points in each cell, but at most 50 cells along a side: more would take longer than they
  // save.
  const int side = std::clamp(static_cast<int>(std::cbrt(static_cast<double>(points.size())) / 2), 2, 50);
  const Grid grid{low, (high - low) / side, side};
  const std::vector<char> inside = cellsInside(grid, planes);
  outer.erase(
      std::remove_if(outer.begin(), outer.end(), [&](int i) { return inside[grid.cellOf(points[at(i)])]; }),
      outer.end());
  return outer;
}

}  // namespace fcl_stpbv::detail
