// A convex cone of directions as a polygon on the unit sphere.
// 1. Start with the hemisphere around a pole. The first cut leaves a lune.
// 2. A further cut clips the polygon by a plane through the origin (Sutherland and Hodgman 1974).
//    No side becomes longer than a third of a circle.
// 3. The middle is the centroid of the triangles between the corners, or, for a sliver, that of the corners.
#include "fcl_stpbv/convex/direction_cone.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

namespace {
constexpr double kLongestSide = -0.5;  // cosine of the longest side
}

DirectionCone::DirectionCone(const Vector3d& pole) : pole_(pole.normalized()) {}

// Two hemispheres intersect in a lune. Its corners are both ends and the middle of each side.
bool DirectionCone::cutHemisphere(const Vector3d& g) {
  constexpr double kParallel = 1e-15;
  Vector3d end = g.cross(pole_);
  if (!(end.norm() > kParallel * g.norm())) return g.dot(pole_) > 0.0;
  end.normalize();
  end = (end - end.dot(pole_) * pole_).normalized();
  corner_[0] = end;
  corner_[1] = pole_.cross(end);
  corner_[2] = -end;
  corner_[3] = end.cross(g).normalized();
  count_ = 4;
  return true;
}

bool DirectionCone::cut(const Vector3d& g) {
  if (count_ == 0) return cutHemisphere(g);
  // One pass round the polygon (Sutherland and Hodgman, 1974). A convex polygon gains at most one corner.
  std::array<Vector3d, kMost> kept;
  std::size_t keptCount = 0;
  double deepest = 0.0;
  const auto keep = [&](const Vector3d& ray) {
    if (keptCount < kept.size()) kept[keptCount++] = ray;
  };
  for (std::size_t i = 0; i < count_; ++i) {
    const Vector3d &from = corner_[i], &to = corner_[i + 1 < count_ ? i + 1 : 0];
    const double f = from.dot(g), t = to.dot(g);
    deepest = std::max(deepest, f);
    if (f >= 0.0) keep(from);
    if ((f < 0.0 && t > 0.0) || (f > 0.0 && t < 0.0)) {
      const Vector3d ray = (from * std::abs(t) + to * std::abs(f));
      const double length = ray.norm();
      if (length > 0.0) keep(ray / length);
    }
  }
  if (keptCount < 3 || !(deepest > 0.0)) return false;
  // The new side may be nearly half a circle, which its ends do not determine. So its middle is added as a
  // corner.
  count_ = 0;
  for (std::size_t i = 0; i < keptCount; ++i) {
    const Vector3d &from = kept[i], &to = kept[i + 1 < keptCount ? i + 1 : 0];
    corner_[count_++] = from;
    if (from.dot(to) < kLongestSide && count_ < kMost) corner_[count_++] = g.cross(from - to).normalized();
    if (count_ == kMost) break;
  }
  return true;
}

Vector3d DirectionCone::middle() const {
  if (count_ == 0) return pole_;
  // Centroid of a fan of triangles from the first corner. Each is weighted by the volume that it spans with
  // the origin, which is zero for three corners on one great circle.
  constexpr double kSliver = 1e-15;  // of the largest volume for sides of these lengths
  Vector3d sum(0, 0, 0);
  double whole = 0, most = 0;
  for (std::size_t i = 1; i + 1 < count_; ++i) {
    const Vector3d &a = corner_[0], b = corner_[i] - a, c = corner_[i + 1] - a;
    const double volume = std::max(0.0, a.dot(b.cross(c)));
    sum += volume * (corner_[i] + corner_[i + 1] + a);
    whole += volume;
    most += b.norm() * c.norm();
  }
  if (whole > kSliver * most && sum.norm() > 0.0) return sum.normalized();
  sum.setZero();
  for (std::size_t i = 0; i < count_; ++i) sum += corner_[i];
  return sum.normalized();
}

}  // namespace fcl_stpbv::detail
