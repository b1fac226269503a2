// A body as points, each with a ball: vertices of a polyhedron or STP-BV (with its over-cover),
// ends of a capsule, polygons of 24 corners around the rims of cylinders and cones, an
// ellipsoid's box. Their hull contains the body.
#include "fcl_stpbv/robot/body_points.h"

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/covered_hull.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

constexpr int kRimCorners = 24;  // the polygon is then 0.9 % wider than the rim

void addRim(double radius, double z, std::vector<Vector3d>& points) {
  const double around = radius / std::cos(kPi / kRimCorners);
  for (int k = 0; k < kRimCorners; ++k) {
    const double angle = kTwoPi * k / kRimCorners;
    points.emplace_back(around * std::cos(angle), around * std::sin(angle), z);
  }
}

void addBox(const Vector3d& half, std::vector<Vector3d>& points) {
  for (int k = 0; k < 8; ++k)
    points.emplace_back(k & 1 ? half.x() : -half.x(), k & 2 ? half.y() : -half.y(),
                        k & 4 ? half.z() : -half.z());
}

std::vector<Vector3d> cornersOf(const Shape& shape) {
  std::vector<Vector3d> points;
  switch (shape.kind) {
    case ShapeKind::point:
      points.emplace_back(0, 0, 0);
      break;
    case ShapeKind::segment:
      points = {Vector3d(0, 0, -shape.half), Vector3d(0, 0, shape.half)};
      break;
    case ShapeKind::box:
    case ShapeKind::ellipsoid:
      addBox(shape.size, points);
      break;
    case ShapeKind::triangle:
      points.assign(shape.corner.begin(), shape.corner.end());
      break;
    case ShapeKind::polytope:
      points.assign(shape.vertices, shape.vertices + shape.vertexCount);
      break;
    case ShapeKind::cylinder:
      addRim(shape.radius, -shape.half, points);
      addRim(shape.radius, shape.half, points);
      break;
    case ShapeKind::cone:
      addRim(shape.radius, -shape.half, points);
      points.emplace_back(0, 0, shape.half);
      break;
    default:  // the body is unbounded
      break;
  }
  return points;
}

double widthAlong(const Vector3d& n, const std::vector<Vector3d>& points) {
  double low = INFINITY, high = -INFINITY;
  for (const Vector3d& point : points) {
    low = std::min(low, n.dot(point));
    high = std::max(high, n.dot(point));
  }
  return high - low;
}

// Least width along the axes of a cube, its face diagonals and its space diagonals.
double narrowestOf(const std::vector<Vector3d>& points) {
  double least = INFINITY;
  for (int k = 14; k < 27; ++k) {
    const Eigen::Vector3i n(k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1);
    least = std::min(least, widthAlong(n.cast<double>().normalized(), points));
  }
  return least;
}

double widestOf(const BodyPoints& body) { return 2 * (body.reach + body.radius); }

}  // namespace

double mostDepth(const BodyPoints& a, const BodyPoints& b) {
  constexpr double kRounding = 1 + 1e-12;  // each of a few products and sums is rounded by 1e-16
  return 0.5 * kRounding * std::min(a.narrowest + widestOf(b), widestOf(a) + b.narrowest);
}

std::optional<BodyPoints> bodyPoints(const fcl::CollisionGeometryd& geometry, const Eigen::Isometry3d& pose) {
  BodyPoints body;
  Shape shape;
  if (const StpBvGeometry* smooth = asStpBv(&geometry)) {
    body.points = smooth->volume().vertices();
    body.radius = CoveredHull(body.points).max(smooth->volume());
  } else if (shapeOf(geometry, shape)) {
    body.points = cornersOf(shape);
    body.radius = shape.margin;
  }
  if (body.points.empty()) return std::nullopt;
  body.narrowest = narrowestOf(body.points) + 2 * body.radius;
  Vector3d low = Vector3d::Constant(INFINITY), high = -low;
  for (Vector3d& point : body.points) {
    point = pose * point;
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  body.centre = (low + high) / 2;
  for (const Vector3d& point : body.points) body.reach = std::max(body.reach, (point - body.centre).norm());
  return body;
}

}  // namespace fcl_stpbv::detail
