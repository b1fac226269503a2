// Two boxes by separating axes: the penetration depth, and the distance if a side and a corner, or two edges,
// are nearest.
//
// 1. The Minkowski difference of two boxes has sides along fifteen axes, in both directions, and no others
//    (box_axes.h). The least overlap along these axes is the depth. A gap along any of them is a lower bound
//    on the distance.
// 2. Find two points opposite each other. For a side of one box, that is a corner of the other; if edges or
//    sides are parallel to it, the point is projected onto both boxes in turn. For two edges, it is where
//    their lines cross.
#include "fcl_stpbv/convex/onto_core.h"
#include "fcl_stpbv/distance/box_axes.h"
#include "fcl_stpbv/distance/shape_pair.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

namespace {

BodyBox bodyBox(const Shape& box) {
  BodyBox body;
  for (int i = 0; i < 3; ++i) body.axis[i][i] = 1.0;
  body.half = pack(box.size);
  return body;
}

/// Finds two points that are `found.gap` apart along `found.n`, starting from A's corner `found.onA` and B's
/// corner `onB`. False if there are none this near.
bool placeOpposite(const ShapePair& p, const BoxAxes& axes, const BoxAxes::Axis& axis, Vector3d onB,
                   OppositePoints& found) {
  constexpr int kTurns = 4;  // a corner above a side needs one, parallel edges and sides mostly two
  const Vector3d way = found.gap * found.n;
  const auto ontoB = [&](const Vector3d& y) { return p.pose.placed(ontoCore(p.b, p.pose.inSecond(y))); };
  if (axis.kind == BoxAxes::Axis::secondSides) onB = ontoB(found.onA + way);
  for (int i = 0; i < kTurns; ++i) {
    if (axis.kind >=
        BoxAxes::Axis::firstCross) {  // along B's edge to the plane through A's edge and the normal
      const Vector3d a = unpack(axes.firstEdge(axis)), b = unpack(axes.secondEdge(axis)),
                     across = b - a.dot(b) * a;
      onB = ontoB(onB - (onB - way - found.onA).dot(across) / across.squaredNorm() * b);
    }
    found.onA = ontoCore(p.a, onB - way);
    found.toB = onB - found.onA;
    if ((found.toB - way).norm() <= p.rounding) return true;
    if (axis.kind < BoxAxes::Axis::firstCross) onB = ontoB(found.onA + way);
  }
  return false;
}

}  // namespace

FCL_STPBV_VECTORIZED
bool oppositeBoxes(const ShapePair& p, OppositePoints& found) {
  if (p.a.kind != ShapeKind::box || p.b.kind != ShapeKind::box) return false;
  const BodyBox a = bodyBox(p.a), b = bodyBox(p.b);
  const BoxAxes axes(a, b, p.pose);
  const BoxAxes::Axis axis = axes.least();
  const double depth = axes.overlap(axis);
  found.n = axes.normal(axis);
  const ShapePair::Corner corner = ShapePair::Difference(p.a, p.b, p.pose).support(found.n);
  found.gap = corner.gap;
  found.onA = corner.onA;
  // If the boxes are apart, points opposite each other prove the gap. If they overlap, the other axes do.
  const bool isWidest = found.gap > 0.0 || (found.gap + depth >= -0.5 * p.rounding &&
                                            axes.noneNearer(-found.gap, 0.5 * p.rounding));
  return isWidest && placeOpposite(p, axes, axis, corner.onA + corner.w, found);
}

}  // namespace fcl_stpbv::detail
