// Computes convex hulls during the search by quickhull (quickhull.h), with planes in double precision. If
// points are flat up to rounding, the rolling ball is used, which is exact and takes ten times as long.
#include "fcl_stpbv/parts/part_hull.h"

#include <Eigen/Geometry>
#include <cmath>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/quickhull.h"
#include "fcl_stpbv/volume/rolling_ball.h"
#include "fcl_stpbv/volume/rolling_cloud.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

// The half space under three points. Points above it by no more than rounding count as on it. So the points
// of a cut, which are in one plane up to rounding, make no slivers.
class HalfSpace {
 public:
  HalfSpace() = default;
  HalfSpace(const Vector3d& a, const Vector3d& b, const Vector3d& c, double extent) : anchor_(a) {
    constexpr double kRounding = 1e-14;  // share of the extent: the rounding of coordinates and of heights
    constexpr double kThin = 1e-4;       // the plane of a thinner triangle is too inaccurate
    const Vector3d u = b - a, v = c - a, n = u.cross(v);
    const double length = n.norm();
    normal_ = n / length;
    onIt_ = kRounding * extent / std::max(kThin, length / (u.norm() * v.norm()));
  }
  bool valid() const { return normal_.allFinite(); }
  int side(const Vector3d& p, double* height) const {
    *height = normal_.dot(p - anchor_);
    return *height > onIt_ ? 1 : -1;
  }

 private:
  Vector3d anchor_{0, 0, 0}, normal_{0, 0, 0};
  double onIt_ = 0;  // heights up to this may be rounding (m)
};

bool byPlanes(const std::vector<Vector3d>& points, PartHull& out) {
  Quickhull<HalfSpace> hull(points, extentOf(points));
  if (!hull.make()) return false;
  std::vector<char> isVertex(points.size(), 0);
  for (const auto& face : hull.faces()) {
    if (face.isGone) continue;
    Triangle corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = hull.at(face.corner[k]);
      isVertex[at(hull.original(face.corner[k]))] = 1;
    }
    out.surface.push_back(corners);
  }
  Vector3d middle = Vector3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i)
    if (isVertex[i]) out.vertices.push_back(points[i]), middle += points[i];
  middle /= static_cast<double>(out.vertices.size());
  for (const auto& [a, b, c] : out.surface)
    out.volume += std::abs((a - middle).dot((b - middle).cross(c - middle))) / 6;
  return true;
}

}  // namespace

double PartHull::diagonal() const { return extentOf(vertices); }

PartHull partHull(const std::vector<Vector3d>& points) {
  PartHull hull;
  if (byPlanes(points, hull)) return hull;
  for (const int v : convexHull(points).vertices) hull.vertices.push_back(points[at(v)]);
  hull.surface = hullTriangles(hull.vertices);
  return hull;
}

}  // namespace fcl_stpbv::detail
