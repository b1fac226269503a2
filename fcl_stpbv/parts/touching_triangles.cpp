// See touching_triangles.h.
#include "fcl_stpbv/parts/touching_triangles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/parts/cut_triangle.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

TouchingTriangles trianglesTouching(const MeshSolid& mesh, const SeenTriangle& seen) {
  const Triangle& t = seen.corners;
  const double slack = seen.slack;
  TouchingTriangles found;
  double largest = 0;
  const Vector3d margin = Vector3d::Constant(4 * slack);
  const Vector3d low = t[0].cwiseMin(t[1]).cwiseMin(t[2]) - margin;
  const Vector3d high = t[0].cwiseMax(t[1]).cwiseMax(t[2]) + margin;
  const auto reach = [&](const auto& points) {
    double least = kInfinity, most = -least;
    for (const Vector3d& p : points) {
      least = std::min(least, seen.normal.dot(p - seen.middle));
      most = std::max(most, seen.normal.dot(p - seen.middle));
    }
    return std::pair{least, most};
  };
  const auto isFar = [&](const std::pair<double, double>& heights) {
    return heights.first > 4 * slack || heights.second < -4 * slack;
  };
  Triangle inwards;
  for (std::size_t k = 0; k < 3; ++k) inwards[k] = seen.normal.cross(t[(k + 1) % 3] - t[k]).normalized();
  mesh.within(low, high, [&](int m) {
    const Triangle& x = mesh.triangles()[at(m)];
    if (!mesh.pieces().closed[at(mesh.pieces().piece[at(m)])] || isFar(reach(x))) return true;
    CutTriangle in(x);
    for (std::size_t k = 0; k < 3 && !in.empty(); ++k)
      in = in.cut(inwards[k], inwards[k].dot(t[k]) + seen.smaller, 0).first;
    if (in.empty()) return true;
    const auto [least, most] = reach(in);
    if (isFar({least, most})) return true;
    const bool above = most > slack, below = least < -slack;
    if (above && below) {
      if (found.crossings++ == 0 || in.area() > largest) found.crossing = m, largest = in.area();
    } else {
      (above ? found.above : below ? found.below : found.flat) = true;
    }
    return found.crossings <= TouchingTriangles::kMost;
  });
  return found;
}

}  // namespace fcl_stpbv::detail
