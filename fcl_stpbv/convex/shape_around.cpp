// The segments, arcs and discs that a simple shape contains around one of its points, by kind:
//
// 1. A box: a segment along each axis that is perpendicular to the normal.
// 2. A cylinder and a cone: the disc of a flat end, the circle of a rim, the generator and the circle at a
//    point of the side. A cone contains both, but not their Minkowski sum; so half of each is taken.
// 3. An ellipsoid: a circle for each of its axes. Along every normal the ellipsoid reaches at least as far
//    beyond its point as all three circles together (docs/theory.md, 5).
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "fcl_stpbv/convex/shape_curvature.h"

namespace fcl_stpbv::detail {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// For a body of revolution: the fraction `part` of the circle through `y`, and, on a flat end, the largest
/// disc around `y` in it. Their sum is the whole disc of the end.
void addAround(double radius, double part, bool isFlat, const Vector3d& y, const Matrix3d& rotation,
               LocalMaximum& around) {
  const double across = std::hypot(y.x(), y.y());
  if (isFlat) around.addDisc(radius - across);
  if (across > 0.0)
    around.addArc(rotation * Vector3d(-y.y() / across, y.x() / across, 0.0), part * across,
                  LocalMaximum::kEndless);
}

}  // namespace

void addShape(const Shape& shape, const Vector3d& y, const Vector3d& m, const Matrix3d& rotation,
              LocalMaximum& around) {
  constexpr double kEdge = 1e-9;      // of the generator: nearer to its end counts as on the rim
  constexpr double kUpright = 1e-15;  // sine: the normal of a flat end, up to rounding
  const bool isUpright = std::hypot(m.x(), m.y()) < kUpright;
  const double half = shape.half, radius = shape.radius;
  switch (shape.kind) {
    case ShapeKind::segment:
      around.addSegment(rotation.col(2), half - std::abs(y.z()));
      break;
    case ShapeKind::box:
      for (int i = 0; i < 3; ++i) around.addSegment(rotation.col(i), shape.size[i] - std::abs(y[i]));
      break;
    case ShapeKind::cylinder:
      around.addSegment(rotation.col(2), half - std::abs(y.z()));
      addAround(radius, 1.0, isUpright, y, rotation, around);
      break;
    case ShapeKind::cone: {
      const Vector3d from = y - Vector3d(0, 0, half);
      const double far = from.norm(), left = std::hypot(radius, 2.0 * half) - far;
      const bool onSide = far > 0.0 && left > kEdge * far;
      if (onSide) around.addSegment(rotation * (from / far), 0.5 * std::min(far, left));
      addAround(radius, onSide ? 0.5 : 1.0, isUpright && m.z() < 0.0, y, rotation,
                around);  // no disc at the apex
      break;
    }
    case ShapeKind::ellipsoid: {
      const Vector3d& axes = shape.size;
      const double most = axes.maxCoeff(), across = m.cwiseProduct(axes).norm();
      for (int i = 0; i < 3; ++i) {
        const double both = axes[(i + 1) % 3] * axes[(i + 2) % 3] / across;
        const Vector3d d = Vector3d::Unit(i).cross(m);
        around.addArc(rotation * d.normalized(), both * both * d.squaredNorm() / most,
                      LocalMaximum::kEndless);
      }
      break;
    }
    case ShapeKind::point:
    case ShapeKind::triangle:
    case ShapeKind::polytope:
    case ShapeKind::halfspace:
    case ShapeKind::plane:
      break;
  }
}

}  // namespace fcl_stpbv::detail
