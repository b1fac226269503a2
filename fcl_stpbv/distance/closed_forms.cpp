// Two simple shapes whose distance has a closed form.
//
// 1. A ball and a shape of few features. Its centre outside the core: the core's nearest point, feature by
//    feature (convex/shape_feature.h), tested against the whole core. Inside: the nearest of the planes that
//    touch the core. The ball around the centre that touches this plane lies in the core, so no other way out
//    is shorter.
// 2. Two capsules: the nearest points of two segments (Lumelsky 1985; Ericson, Real-Time Collision Detection,
//    5.1.9). Take the point of the first segment that is nearest to the line of the second, or, for parallel
//    segments, to the middle of the second. Project it onto the second segment, and the result back onto the
//    first. This corrects the points if a segment ends before.
// 3. Two boxes, by separating axes: the penetration depth, and the distance if a side and a corner, or two
//    edges, are nearest. The Minkowski difference of two boxes has sides along fifteen axes, in both
//    directions, and no others (box_axes.h). The least overlap along these axes is the depth. A gap along any
//    of them is a lower bound on the distance. Two points opposite each other are then found: for a side of
//    one box, a corner of the other; if edges or sides are parallel to it, the point is projected onto both
//    boxes in turn. For two edges, it is where their lines cross.
#include <algorithm>
#include <cmath>

#include "fcl_stpbv/convex/onto_core.h"
#include "fcl_stpbv/convex/shape_feature.h"
#include "fcl_stpbv/distance/box_axes.h"
#include "fcl_stpbv/distance/shape_pair.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

namespace {

/// The nearest of the planes that touch a core, for a point inside the core.
struct TouchingPlane {
  double away;     ///< from the point (m)
  Packed outward;  ///< unit
};

bool hasPlanes(const Shape& core) {
  return core.kind == ShapeKind::box || core.kind == ShapeKind::cylinder || core.kind == ShapeKind::cone;
}

/// The nearest touching plane of a core with hasPlanes(). The point `x` is inside the core or next to its
/// surface; `f` is the result of nearestFeature() at `x`.
TouchingPlane nearestPlane(const Shape& core, const ShapeFeature& f, const Packed& x) {
  TouchingPlane nearest{kInfinity, {}};
  const auto plane = [&](double away, const Packed& outward) {
    if (away < nearest.away) nearest = {away, outward};
  };
  if (core.kind == ShapeKind::box) {
    for (int i = 0; i < 3; ++i) {
      Packed axis{};
      axis[i] = std::copysign(1.0, x[i]);
      plane(core.size[i] - std::abs(x[i]), axis);
    }
    return nearest;
  }
  const double away = std::sqrt(x[0] * x[0] + x[1] * x[1]);
  const Packed up{0, 0, 1, 0}, out = away > 0.0 ? Packed{x[0] / away, x[1] / away, 0, 0} : Packed{1, 0, 0, 0};
  plane(core.half + x[2], -up);
  if (core.kind == ShapeKind::cone) {
    plane(f.sine * (core.half - x[2]) - f.cosine * away, f.cosine * out + f.sine * up);
  } else {
    plane(core.half - x[2], up);
    plane(core.radius - away, out);
  }
  return nearest;
}

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

/// A ball `a` and the core of `b`. If there is no closed form, `found` may still have a gap along a normal.
FCL_STPBV_VECTORIZED
bool oppositeBall(const ShapePair& p, OppositePoints& found) {
  using Kind = ShapeFeature::Kind;
  if (p.a.kind != ShapeKind::point) return false;
  found.onA.setZero();
  if (p.b.kind == ShapeKind::point) return p.isNearest(p.pose.translation, found);
  const Packed x = p.pose.rotation.inverse(-p.pose.translation);
  const ShapeFeature f = nearestFeature(p.b, x);
  const bool isInside = f.kind == Kind::inside;
  if (f.kind == Kind::none || f.kind == Kind::whole || (isInside && !hasPlanes(p.b))) return false;
  const Packed d = isInside ? Packed{} : p.pose.rotation * -wayFrom(f, x);
  if (dot(d, d) > p.rounding * p.rounding) return p.isNearest(d, found);
  // The centre is inside, or so near the surface that the vector is too short to give a normal.
  if (!hasPlanes(p.b)) return false;
  const TouchingPlane plane = nearestPlane(p.b, f, x);
  const Packed n = p.pose.rotation * -plane.outward;
  found.n = unpack(n);
  found.gap = isInside ? -std::max(plane.away, 0.0) : std::max(-plane.away, 0.0);
  found.toB = unpack(isInside ? found.gap * n : d);
  return true;
}

/// Two capsules whose cores are apart.
FCL_STPBV_VECTORIZED
bool oppositeSegments(const ShapePair& p, OppositePoints& found) {
  if (p.a.kind != ShapeKind::segment || p.b.kind != ShapeKind::segment) return false;
  const Packed axis = p.pose.rotation.axis(2), &middle = p.pose.translation, z{0, 0, 1, 0};
  const auto within = [](double x, double half) { return std::clamp(x, -half, half); };
  const double cosine = axis[2], sine2 = axis[0] * axis[0] + axis[1] * axis[1],
               across = axis[0] * middle[0] + axis[1] * middle[1];
  double s = within(sine2 > 0.0 ? middle[2] - cosine * across / sine2 : middle[2], p.a.half);
  const double t = within(s * cosine - dot(axis, middle), p.b.half);
  s = within(middle[2] + t * cosine, p.a.half);
  found.onA = Vector3d(0.0, 0.0, s);
  return p.isNearest(middle + t * axis - s * z, found);
}

/// Two boxes, unless a corner is nearest to a corner or to an edge.
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

}  // namespace

bool oppositeInClosedForm(const ShapePair& p, OppositePoints& found) {
  return oppositeBall(p, found) || oppositeSegments(p, found) || oppositeBoxes(p, found);
}

}  // namespace fcl_stpbv::detail
