// Moves a pair along twists, and computes its distance and second derivatives by the library. The signature
// of an answer names its patches, and for a shape the corners, sides and rims that the normal selects.
#include "test/distance/derivatives.h"

#include <cmath>

#include "fcl_stpbv/distance/distance.h"

namespace fcl_stpbv::test {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Poses after(const Poses& at, const Twists& twists, double t) {
  Poses to = at;
  for (int body = 0; body < 2; ++body) {
    const Vector3d v = twists.segment<3>(6 * body), w = twists.segment<3>(6 * body + 3);
    Isometry3d& p = to[static_cast<std::size_t>(body)];
    const double angle = w.norm();
    if (angle > 0) p.linear() = Eigen::AngleAxisd(t * angle, w / angle).toRotationMatrix() * p.linear();
    p.translation() += t * v;
  }
  return to;
}

Distance DerivativePair::ask(const Poses& at) const {
  return other ? distance(*volume, at[0], *other, at[1]) : distance(*volume, at[0], shape.shape, at[1]);
}

bool DerivativePair::second(const Poses& at, const Distance& d, DistanceHessian& h) const {
  return other ? hessian(*volume, at[0], *other, at[1], d, h)
               : hessian(*volume, at[0], shape.shape, at[1], d, h);
}

std::vector<int> DerivativePair::signature(const Poses& at, const Distance& d) const {
  std::vector<int> names{d.patch[0], d.patch[1]};
  if (other) return names;
  constexpr double kLevel = 1e-12;  // rad; normals of flat features are accurate to about 1e-15
  const Vector3d m = -(at[1].linear().transpose() * d.normal);
  const double across = std::hypot(m.x(), m.y());
  const Shape& s = shape.shape;
  if (shape.vertices && !shape.vertices->empty()) {
    double most = -1e300;
    for (const Vector3d& p : *shape.vertices) most = std::max(most, m.dot(p));
    for (std::size_t i = 0; i < shape.vertices->size(); ++i)
      if (most - m.dot((*shape.vertices)[i]) <= kLevel * s.reach) names.push_back(static_cast<int>(i));
    return names;
  }
  const auto side = [&](double x) { names.push_back(x > kLevel ? 1 : x < -kLevel ? -1 : 0); };
  if (s.kind == ShapeKind::segment || s.kind == ShapeKind::cylinder || s.kind == ShapeKind::cone) side(m.z());
  if (s.kind == ShapeKind::cylinder || s.kind == ShapeKind::cone) side(across);
  if (s.kind == ShapeKind::cone)
    side((2 * s.half * m.z() - s.radius * across) / std::hypot(2 * s.half, s.radius));
  if (s.unbounded()) side(s.normal.dot(m));
  return names;
}

Twists gradientOf(const Distance& d, const Poses& at) {
  Twists g;
  g << d.gradient(0, at[0].translation()), d.gradient(1, at[1].translation());
  return g;
}

}  // namespace fcl_stpbv::test
