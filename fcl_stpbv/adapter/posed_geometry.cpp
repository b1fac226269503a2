// Geometries as hierarchies of boxes, for the descent in posed_geometry.h.
// 1. An STP-BV or a shape is one part, with the box of its own axes and its support points. Meshes and trees
//    give the boxes of FCL's hierarchies (element_tree.h).
// 2. Two parts are at least as far apart as their projections on any axis (separating axis test: Gottschalk,
//    Lin, Manocha 1996). They are also at least as far apart as one box and the box of the same axes around
//    the other. The axes tested are a normal that the caller provides, the line of the centres and both
//    boxes' axes. Cross products of edges are omitted; the bound is then looser, but never wrong. A half
//    space or a plane has only one axis, its normal.
#include "fcl_stpbv/adapter/posed_geometry.h"

#include <cmath>

#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

Isometry3d between(const Isometry3d& pose1, const Isometry3d& pose2) {
  Isometry3d result = Isometry3d::Identity();
  result.linear() = pose1.linear().transpose() * pose2.linear();
  result.translation() = pose1.linear().transpose() * (pose2.translation() - pose1.translation());
  return result;
}

constexpr double kBoxRounding = 1e-14;  // rounding of a gap between two parts, as a share of their size

/// The gap between a part and a half space or plane, which has no box, along the normal of the latter.
/// `place` gives its position and axes.
double gapOfFlat(const Shape& flat, const OrientedBox& place, const PosedGeometry::Part& part) {
  const Vector3d n = place.axes * flat.normal;
  const double height = n.dot(part.box.centre - place.centre);
  return (flat.kind == ShapeKind::plane ? std::abs(height) : height) - part.box.reach(n) -
         kBoxRounding * (place.centre.lpNorm<1>() + part.coordinates);
}

/// Distance of two boxes with the same axes, from their gaps along these axes. If the boxes overlap: the
/// largest gap, which is below 0.
double apartBy(const Vector3d& gap) {
  const double most = gap.maxCoeff();
  return most > 0.0 ? gap.cwiseMax(0.0).norm() : most;
}

/// The gap between `a` and a box of the same axes around `b`, whose centre is at `d` from a's.
double gapAlongAxes(const PosedGeometry::Part& a, const PosedGeometry::Part& b, const Vector3d& d) {
  Vector3d gap;
  for (int i = 0; i < 3; ++i) {
    const Vector3d axis = a.box.axes.col(i);
    const double along = axis.dot(d);
    gap(i) = std::abs(along) - a.box.half(i) - b.reach(std::copysign(1.0, -along) * axis);
  }
  return apartBy(gap);
}

/// The box with these axes around a body. `reach(d)` is how far the body reaches from `place` along `d`.
template <typename Reach>
OrientedBox boxAlong(const Matrix3d& axes, const Vector3d& place, const Reach& reach) {
  OrientedBox box{place, axes, {0, 0, 0}};
  for (int i = 0; i < 3; ++i) {
    const Vector3d axis = axes.col(i);
    const double up = reach(axis), down = reach(Vector3d(-axis));
    box.centre += 0.5 * (up - down) * axis;
    box.half(i) = 0.5 * (up + down);
  }
  return box;
}

/// Distance of a body's box from a cell with the same axes; below 0 if they overlap. `inside` becomes whether
/// the box's centre is in the cell. Hardly any plane then separates the cell from the body.
double gapFromCell(const OrientedBox& body, const OrientedBox& cell, bool& inside) {
  const Vector3d off = (cell.axes.transpose() * (body.centre - cell.centre)).cwiseAbs() - cell.half;
  inside = off.maxCoeff() <= 0.0;
  return apartBy(off - body.half);
}

/// gapOf() for two boxes. The relative rotation matrix gives the extent of each box along the other's axes.
FCL_STPBV_VECTORIZED
double gapOfBoxes(const OrientedBox& a, const OrientedBox& b, double rounding, double enough,
                  const Vector3d& n) {
  constexpr double kNone = -kInfinity;
  const auto size = [](const Packed& v) { return larger(v, -v); };
  const Rotation axesA(a.axes), axesB(b.axes);
  const Packed halfA = pack(a.half), halfB = pack(b.half), d = pack(b.centre) - pack(a.centre);
  const Packed alongA = size(axesA.inverse(d)), alongB = size(axesB.inverse(d));
  const double length = std::sqrt(dot(d, d));
  if (!(length > 0.0)) return kNone;
  double most = kNone;
  if (!n.isZero(0)) {
    const Packed m = pack(n);
    most = dot(m, d) - dot(halfA, size(axesA.inverse(m))) - dot(halfB, size(axesB.inverse(m))) - rounding;
  }
  if (!(most > enough))
    most = std::max(most, length - (dot(halfA, alongA) + dot(halfB, alongB)) / length - rounding);
  const auto alongAxes = [&](const Packed& along, const Packed& half, const Rotation& axes,
                             const Packed& othersHalf, const Rotation& others) {
    Packed gap = along - half;
    for (int i = 0; i < 3; ++i) gap -= othersHalf[i] * size(axes.inverse(others.axis(i)));
    const double widest = std::max({gap[0], gap[1], gap[2]});
    const Packed outside = larger(gap, Packed{});
    return (widest > 0.0 ? std::sqrt(dot(outside, outside)) : widest) - rounding;
  };
  if (!(most > enough)) most = std::max(most, alongAxes(alongA, halfA, axesA, halfB, axesB));
  if (!(most > enough)) most = std::max(most, alongAxes(alongB, halfB, axesB, halfA, axesA));
  return most;
}

}  // namespace

bool isOccupied(const fcl::CollisionGeometryd& geometry) {
  return geometry.getNodeType() == fcl::GEOM_OCTREE || !(geometry.cost_density < geometry.threshold_occupied);
}

bool isConvex(const fcl::CollisionGeometryd& geometry, ConvexBody& body) {
  if (const StpBvGeometry* g = asStpBv(&geometry)) {
    body.volume = &g->volume();
    return true;
  }
  return shapeOf(geometry, body.shape) && body.shape.valid();
}

Distance distance(const ConvexBody& a, const ConvexBody& b, PairCache* cache) {
  Distance found = a.volume && b.volume ? distance(*a.volume, a.pose, *b.volume, b.pose, cache)
                   : a.volume           ? distance(*a.volume, a.pose, b.shape, b.pose, cache)
                   : b.volume           ? distance(a.shape, a.pose, *b.volume, b.pose, cache)
                                        : distance(a.shape, a.pose, b.shape, b.pose);
  if (cache && !a.volume && !b.volume) *cache = {found.normal};
  found.lower -= a.rounding + b.rounding;
  found.upper += a.rounding + b.rounding;
  return found;
}

bool areBodies(const fcl::CollisionGeometryd& geometry1, const Isometry3d& pose1,
               const fcl::CollisionGeometryd& geometry2, const Isometry3d& pose2, ConvexBody& a,
               ConvexBody& b) {
  if (!isConvex(geometry1, a) || !isConvex(geometry2, b)) return false;
  a.pose = pose1;
  b.pose = pose2;
  return a.volume || b.volume ||
         (!(a.unbounded() && b.unbounded()) && makeRigid(a.pose) && makeRigid(b.pose));
}

PosedGeometry::PosedGeometry(const fcl::CollisionGeometryd& geometry, const Isometry3d& pose,
                             const Isometry3d& inFrame, bool known, const ElementTree* tree)
    : tree_(tree ? *tree : ElementTree(geometry, known)),
      inFrame_(inFrame),
      unmoved_(inFrame.matrix() == Eigen::Matrix4d::Identity()) {
  body_.pose = pose;
  isShape_ = isConvex(geometry, body_) && !body_.volume;
}

PosedGeometry::Part PosedGeometry::whole() const {
  if (!isBody()) return part(tree_.root());
  OrientedBox own{body_.shape.centre, Matrix3d::Identity(), {0, 0, 0}};
  if (!unbounded())
    own = boxAlong(own.axes, {0, 0, 0}, [this](const Vector3d& m) { return body_.localSupport(m); });
  return part({-1, true, nullptr, own}, &body_);
}

std::size_t PosedGeometry::children(const Part& of, std::array<Part, 8>& child) const {
  std::array<ElementTree::Node, 8> node;
  const auto count = static_cast<std::size_t>(tree_.children(of.node, node));
  for (std::size_t i = 0; i < count; ++i) child[i] = part(node[i]);
  return count;
}

bool PosedGeometry::body(const Part& leaf, ConvexBody& body) const {
  body = body_;
  if (isBody()) return true;
  Vector3d place;
  if (!tree_.element(leaf.node, body.shape, place)) return false;
  body.pose.translation() = body_.pose * place;
  body.rounding = placeRounding(body_.pose, place);
  return true;
}

PosedGeometry::Part PosedGeometry::part(const ElementTree::Node& node, const ConvexBody* body) const {
  const OrientedBox& own = node.box;
  Part part{own, node.leaf, node, body, own.half.sum() + own.centre.lpNorm<1>()};
  if (!unmoved_) part.box = {inFrame_ * own.centre, inFrame_.linear() * own.axes, own.half};
  part.coordinates += part.box.centre.lpNorm<1>();
  return part;
}

// A pose that is not rigid is kept, but the results from it are never used.
PosedPair::PosedPair(const fcl::CollisionGeometryd& geometry1, Isometry3d pose1,
                     const fcl::CollisionGeometryd& geometry2, Isometry3d pose2, bool known,
                     const KnownTrees& trees)
    : valid(makeRigid(pose1) && makeRigid(pose2)),
      first(geometry1, pose1, Isometry3d::Identity(), known, trees[0]),
      second(geometry2, pose2, between(pose1, pose2), known, trees[1]),
      toWorld(pose1.linear()) {
  valid = valid && first.known() && second.known() && !(first.unbounded() && second.unbounded());
  if (!valid) return;
  const auto boxBeside = [](const PosedGeometry& tree, const PosedGeometry& other) {
    const PosedGeometry::Part body = other.whole();
    return boxAlong(tree.axes(), body.box.centre, [&](const Vector3d& axis) { return body.reach(axis); });
  };
  if (first.loose() && second.isBody() && !second.unbounded()) besideTree = boxBeside(first, second);
  if (second.loose() && first.isBody() && !first.unbounded()) besideTree = boxBeside(second, first);
}

double boxRounding(const PosedGeometry::Part& a, const PosedGeometry::Part& b) {
  return kBoxRounding * (a.coordinates + b.coordinates) + (a.body ? a.body->supportError() : 0.0) +
         (b.body ? b.body->supportError() : 0.0);
}

double gapOf(const PosedPair& pair, const PosedGeometry::Part& a, const PosedGeometry::Part& b, double enough,
             const Vector3d& n) {
  if (pair.first.unbounded()) return gapOfFlat(pair.first.body().shape, a.box, b);
  if (pair.second.unbounded()) return gapOfFlat(pair.second.body().shape, b.box, a);
  const double rounding = boxRounding(a, b);
  if (!a.body && !b.body) return gapOfBoxes(a.box, b.box, rounding, enough, n);
  const Vector3d d = b.box.centre - a.box.centre;
  const double length = d.norm();
  if (!(length > 0.0)) return -kInfinity;
  const auto along = [&](const Vector3d& axis) {
    return axis.dot(d) - a.reach(axis) - b.reach(-axis) - rounding;
  };
  double most = -kInfinity;
  const auto tryAxes = [&](const PosedGeometry::Part& of, const PosedGeometry::Part& other,
                           const Vector3d& to) {
    if (!(most > enough)) most = std::max(most, gapAlongAxes(of, other, to) - rounding);
  };
  if (pair.besideTree) {
    bool inside = false;
    most = gapFromCell(*pair.besideTree, a.body ? b.box : a.box, inside) - rounding;
    if (inside) return most;
  }
  if (pair.besideTree && a.body) tryAxes(a, b, d);
  if (pair.besideTree && b.body) tryAxes(b, a, -d);
  if (!(most > enough) && !n.isZero(0)) most = std::max(most, along(n));
  if (!(most > enough)) most = std::max(most, along(d / length));
  if (!pair.besideTree) tryAxes(a, b, d), tryAxes(b, a, -d);
  return most;
}

}  // namespace fcl_stpbv::detail
