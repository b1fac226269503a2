// The "sandwich" approximation of a convex body. Take the convex hull of some surface points. Compute the
// body's support point along each face's normal, and add it if it is outside of the face by more than the
// tolerance. Repeat. Only a support function is needed, so the same code draws volumes, primitives and hulls.
#include "fcl_stpbv/report/outline.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <functional>

#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "fcl_stpbv/convex/hull_graph.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

using Eigen::Vector3d;
using Support = std::function<Vector3d(const Vector3d&)>;  ///< the body's furthest point along a unit vector

// A point of the body outside the hull of the other points, and by how much (m).
struct Missing {
  double gap;
  Vector3d point;
};

std::vector<Missing> missing(const HullGraph& hull, const Support& support, double tolerance) {
  std::vector<Missing> found;
  for (int f = 0; f < hull.faceCount(); ++f) {
    const Vector3d& n = hull.faceNormal(f);
    const Vector3d x = support(n);
    const double gap = n.dot(x - hull.centre() - hull.point(hull.faces()[static_cast<std::size_t>(f)][0]));
    if (gap > tolerance) found.push_back({gap, x});
  }
  std::sort(found.begin(), found.end(), [](const Missing& a, const Missing& b) { return a.gap > b.gap; });
  return found;
}

TriangleMesh trianglesOf(const HullGraph& hull) {
  TriangleMesh mesh;
  for (int v = 0; v < hull.vertexCount(); ++v) mesh.vertices.push_back(hull.point(v) + hull.centre());
  for (const HullGraph::Ring& ring : hull.faces())
    for (std::size_t i = 2; i < ring.size(); ++i) mesh.triangles.push_back({ring[0], ring[i - 1], ring[i]});
  return mesh;
}

TriangleMesh grow(const Support& support, double tolerance, std::size_t most) {
  std::vector<Vector3d> points;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (x != 0 || y != 0 || z != 0) points.push_back(support(Vector3d(x, y, z).normalized()));
  for (;;) {
    const HullGraph hull(points);
    const std::vector<Missing> more = missing(hull, support, tolerance);
    if (more.empty() || points.size() >= most) return trianglesOf(hull);
    for (std::size_t i = 0; i < more.size() && points.size() < most; ++i) points.push_back(more[i].point);
  }
}

}  // namespace

TriangleMesh outline(const fcl::CollisionGeometryd& geometry, double tolerance, int most) {
  const auto limit = static_cast<std::size_t>(most);
  if (const StpBvGeometry* smooth = asStpBv(&geometry))
    return grow([&](const Vector3d& n) { return smooth->volume().surfacePoint(n); }, tolerance, limit);
  Shape shape;
  if (!shapeOf(geometry, shape) || shape.unbounded()) return {};
  return grow([&](const Vector3d& n) -> Vector3d { return shape.support(n) + shape.margin * n; }, tolerance,
              limit);
}

}  // namespace fcl_stpbv::report
