// A ball and a simple shape of few features: the shortest vector between the ball's centre and the core's
// surface, in closed form.
//
// 1. Outside the core: its nearest point, feature by feature (convex/shape_feature.h), tested against the
//    whole core.
// 2. Inside: the nearest of the planes that touch the core. The ball around the centre that touches this
//    plane lies in the core, so no other way out is shorter.
#include <algorithm>
#include <cmath>

#include "fcl_stpbv/convex/shape_feature.h"
#include "fcl_stpbv/distance/shape_pair.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {

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

}  // namespace

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

}  // namespace fcl_stpbv::detail
