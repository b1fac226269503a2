// The segments, arcs and discs that a simple shape contains around one of its points, by kind:
//
// 1. A box: a segment along each axis that is across the normal.
// 2. A cylinder and a cone: of a flat end its disc, of a rim its circle, of a side the generator and the
//    circle there. A cone holds both of these, but not their sum: half of each.
// 3. An ellipsoid: it is further out than its point by as much as circles along each of its axes
//    (docs/theory.md, 5).
#include "fcl_stpbv/convex/shape_around.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace fcl_stpbv::detail {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Of a body of revolution: the circle through `y`, `part` of it, and on a flat end its disc, as large as it
/// is around `y`. Both together are the disc of all of the end.
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
  constexpr double kEdge = 1e-9;      // of the generator: nearer to its end is on the rim
  constexpr double kUpright = 1e-15;  // a sine; flat ends have their normal to rounding
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
