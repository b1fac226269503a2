// Balls around volumes and primitives in closed form, around the corners of a polyhedron, else FCL's own. For
// a mesh or an octree whose box FCL has not computed yet (computeLocalAABB()), it is the ball around the box
// at the root of its tree.
#include "fcl_stpbv/robot/bounding_ball.h"

#include <fcl/geometry/shape/convex.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fcl_stpbv/adapter/element_tree.h"
#include "fcl_stpbv/adapter/posed_geometry.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/link_geometry.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

// About the middle of their box: a smaller ball than about their mean.
BoundingBall ballAround(const std::vector<Vector3d>& corners) {
  Vector3d low = corners.front(), high = low;
  for (const Vector3d& corner : corners) low = low.cwiseMin(corner), high = high.cwiseMax(corner);
  BoundingBall ball{0.5 * (low + high), 0};
  for (const Vector3d& corner : corners) ball.radius = std::max(ball.radius, (corner - ball.centre).norm());
  return ball;
}

BoundingBall ballOf(const fcl::CollisionGeometryd& geometry) {
  ConvexBody body;
  if (!isConvex(geometry, body)) {
    if ((geometry.aabb_local.min_.array() <= geometry.aabb_local.max_.array()).all())
      return {geometry.aabb_center, geometry.aabb_radius};
    const ElementTree tree(geometry);
    if (!tree.any() || !tree.finite()) return {Vector3d::Zero(), kInfinity};
    const OrientedBox box = tree.root().box;
    return {box.centre, box.half.norm()};
  }
  if (body.volume) return {body.volume->centre(), body.volume->enclosingRadius()};
  if (body.unbounded()) return {Vector3d::Zero(), kInfinity};
  if (body.shape.kind == ShapeKind::polytope)
    return ballAround(static_cast<const fcl::Convexd&>(geometry).getVertices());
  return {body.shape.centre, body.shape.reach + body.shape.margin};
}

}  // namespace

BoundingBall boundingBall(const fcl::CollisionGeometryd& geometry) {
  const BoundingBall ball = ballOf(geometry);
  if (ball.centre.allFinite() && std::isfinite(ball.radius)) return ball;
  return {Vector3d::Zero(), kInfinity};
}

BoundingBall boundingBall(const Body& body) {
  if (std::isfinite(body.radius)) return {body.centre, body.radius};
  const BoundingBall ball = boundingBall(*body.geometry);
  return {body.pose * ball.centre, ball.radius};
}

}  // namespace fcl_stpbv::detail
