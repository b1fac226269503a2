// A convex cone of directions as a polygon on the unit sphere.
// 1. Start: the hemisphere around a pole, four corners just above its rim.
// 2. A cut clips the polygon by a plane through the origin (Sutherland and Hodgman 1974).
// 3. The middle is the centroid of the triangles between the corners.
#include "fcl_stpbv/convex/direction_cone.h"

#include <Eigen/Geometry>
#include <cmath>

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

DirectionCone::DirectionCone(const Vector3d& pole) {
  constexpr double kRim =
      1e-8;  // rays on the equator itself would leave opposite corners with no arc between them
  const Vector3d z = pole.normalized();
  int smallest = 0;
  z.cwiseAbs().minCoeff(&smallest);
  const Vector3d x = z.cross(Vector3d::Unit(smallest)).normalized();
  const Vector3d y = z.cross(x);
  corner_[0] = x + kRim * z;
  corner_[1] = y + kRim * z;
  corner_[2] = -x + kRim * z;
  corner_[3] = -y + kRim * z;
}

bool DirectionCone::cut(const Vector3d& g) {
  // One pass round the polygon (Sutherland and Hodgman, 1974). A convex polygon gains at most one corner.
  std::array<Vector3d, kMaxCuts + 4> kept;
  int keptCount = 0;
  const auto keep = [&](const Vector3d& ray) {
    if (keptCount < static_cast<int>(kept.size())) kept[static_cast<std::size_t>(keptCount++)] = ray;
  };
  for (int i = 0; i < count_; ++i) {
    const Vector3d& from = corner_[static_cast<std::size_t>(i)];
    const Vector3d& to = corner_[static_cast<std::size_t>(i + 1 < count_ ? i + 1 : 0)];
    const double f = from.dot(g), t = to.dot(g);
    if (f >= 0.0) keep(from);
    if ((f < 0.0 && t > 0.0) || (f > 0.0 && t < 0.0)) {
      const Vector3d ray = (from * std::abs(t) + to * std::abs(f));
      const double length = ray.norm();
      if (length > 0.0) keep(ray / length);
    }
  }
  if (keptCount < 3) return false;
  corner_ = kept;
  count_ = keptCount;
  return true;
}

Vector3d DirectionCone::middle() const {
  // Centroid of the polygon through the corners, fanned out from the first one.
  Vector3d sum(0, 0, 0);
  for (int i = 1; i + 1 < count_; ++i) {
    const Vector3d& a = corner_[0];
    const Vector3d& b = corner_[static_cast<std::size_t>(i)];
    const Vector3d& c = corner_[static_cast<std::size_t>(i + 1)];
    sum += (b - a).cross(c - a).norm() * (a + b + c);
  }
  const double length = sum.norm();
  if (length > 0.0) return sum / length;
  for (int i = 0; i < count_; ++i) sum += corner_[static_cast<std::size_t>(i)];  // a sliver without area
  return sum.normalized();
}

}  // namespace fcl_stpbv::detail
