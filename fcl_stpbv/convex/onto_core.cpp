// The nearest point of a simple shape's core, in closed form; a polytope's by GJK.
#include "fcl_stpbv/convex/onto_core.h"

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/convex/gjk.h"
#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/convex/support.h"

namespace fcl_stpbv::detail {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

/// The polytope's point nearest to `y`, by GJK.
Vector3d nearestOfCorners(const Shape& polytope, const Vector3d& y) {
  using Difference = ConvexDifference<const Shape, const Shape>;
  constexpr int kSteps = 60;
  const Shape origin;
  Isometry3d at = Isometry3d::Identity();
  at.translation() = y;
  const RelativePose pose(at, Isometry3d::Identity());
  Difference difference(origin, polytope, pose);
  const auto found = gjk<Difference::Corner>(difference, {}, (polytope.centre - y).normalized(), 0.0, kSteps,
                                             [](double, double) { return false; });
  Simplex<Difference::Corner> nearest;
  return y + reduceToNearest(found.simplex, nearest).point;
}

/// The cone's point nearest to `y`. If `y` is outside the side, it is on a generator. On a flat cone it may
/// be far from the point at y's height.
Vector3d ontoCone(double radius, double half, const Vector3d& y) {
  const double across = std::hypot(y.x(), y.y()), height = 2.0 * half, down = half - y.z(),
               squared = radius * radius + height * height;
  double out = std::min(across, radius), z = std::clamp(y.z(), -half, half);
  if (height * across > radius * down && squared > 0.0) {
    const double t = std::clamp((radius * across + height * down) / squared, 0.0, 1.0);
    out = t * radius;
    z = half - t * height;
  }
  const double scale = across > 0.0 ? out / across : 0.0;
  return {scale * y.x(), scale * y.y(), z};
}

}  // namespace

Vector3d ontoCore(const Shape& core, const Vector3d& y) {
  const double half = core.half, z = std::clamp(y.z(), -half, half);
  switch (core.kind) {
    case ShapeKind::point:
      return {0, 0, 0};
    case ShapeKind::segment:
      return {0, 0, z};
    case ShapeKind::box:
      return y.cwiseMax(-core.size).cwiseMin(core.size);
    case ShapeKind::cylinder: {
      const double across = std::hypot(y.x(), y.y()),
                   scale = across > core.radius ? core.radius / across : 1.0;
      return {scale * y.x(), scale * y.y(), z};
    }
    case ShapeKind::cone:
      return ontoCone(core.radius, half, y);
    case ShapeKind::ellipsoid: {
      Vector3d p = y;
      for (int i = 0; i < 3; ++i)
        if (!(core.size[i] > 0.0)) p[i] = 0.0;
      const auto scaled = [&] { return Vector3d(p.array() / core.size.array().max(1e-300)); };
      const Vector3d gradient = scaled().array() / core.size.array().max(1e-300);
      const double beyond = scaled().squaredNorm() - 1.0;
      if (beyond > 0.0) p -= (0.5 * beyond / gradient.squaredNorm()) * gradient;
      return p / std::max(1.0, scaled().norm());
    }
    case ShapeKind::triangle:
      return ontoTriangle(core.corner, y);
    case ShapeKind::polytope:
      return nearestOfCorners(core, y);
    case ShapeKind::halfspace:
    case ShapeKind::plane:
      break;
  }
  return y;
}

Vector3d ontoTriangle(const std::array<Vector3d, 3>& corner, const Vector3d& y) {
  Vector3d nearest = corner[0];
  const auto offer = [&](const Vector3d& p) {
    if ((p - y).squaredNorm() < (nearest - y).squaredNorm()) nearest = p;
  };
  for (std::size_t i = 0; i < 3; ++i) offer(ontoSegment(corner[i], corner[(i + 1) % 3], y));
  const Vector3d e = corner[1] - corner[0], f = corner[2] - corner[0], m = e.cross(f);
  const double area = std::max(m.squaredNorm(), 1e-300);
  double v = 0.0, w = 0.0;
  for (int round = 0; round < 2; ++round) {  // the second round corrects the rounding of the first
    const Vector3d beside = y - (corner[0] + v * e + w * f);
    v += beside.cross(f).dot(m) / area;
    w += e.cross(beside).dot(m) / area;
  }
  if (v >= 0.0 && w >= 0.0 && v + w <= 1.0) offer(corner[0] + v * e + w * f);
  return nearest;
}

}  // namespace fcl_stpbv::detail
