// The nearest point of a cylinder or a cone to an STP-BV's core, feature by feature.
#include <algorithm>
#include <cmath>

#include "fcl_stpbv/distance/shape_query.h"

namespace fcl_stpbv {

using Eigen::Vector3d;

namespace {

/// The straight generators of a cone's side: on a small circle of normals all of them pass through the apex,
/// so the gap is that of the apex, and its slope says on which generator the body's point lies.
class ConeSide {
 public:
  ConeSide(const Vector3d& apex, const Vector3d& axis, double radius, double height)
      : apex_(apex), axis_(axis), slant_(std::hypot(radius, height)) {
    if (!(slant_ > 0.0)) return;  // a point
    cos_ = height / slant_;
    sin_ = radius / slant_;
  }

  /// Newton on the angle around the axis, from the side that faces `n`.
  Nearest nearest(ShapeQuery& q, const StartNormal& start) const {
    constexpr int kSteps = 40;
    Vector3d e = -(start.n - start.n.dot(axis_) * axis_);
    e = e.squaredNorm() > 1e-20 ? Vector3d(e.normalized()) : axis_.unitOrthogonal();
    State x = at(q, e, start.patch);
    Nearest found;
    for (int i = 0; i < kSteps; ++i) {
      ++q.pairs;
      if (std::abs(x.slope) <= 0.25 * q.rounding.across) break;
      double turn = x.bend < 0.0 ? -x.slope / x.bend : std::copysign(0.5, x.slope);
      turn = std::clamp(turn, -1.0, 1.0);
      State y = at(q, turned(x.e, turn), x.view.patch);
      for (int k = 0; k < 50 && !better(q, y, x); ++k) {
        turn *= 0.4;
        y = at(q, turned(x.e, turn), x.view.patch);
      }
      if (!better(q, y, x)) break;
      x = y;
    }
    found.n = x.view.n;
    found.patch = x.view.patch;
    found.gap = x.view.gap(apex_);
    found.y = x.view.point + found.n.dot(apex_ - x.view.point) * found.n;
    const Vector3d generator = cos_ * -axis_ + sin_ * x.e;
    const double along = (found.y - apex_).dot(generator);
    found.corners = 2;
    found.apart = found.gap > 0.0 && along >= 0.0 && along <= slant_;
    // What rounding leaves across the generator must not show: the point is put onto it.
    if (found.apart) found.y = apex_ + along * generator;
    return found;
  }

 private:
  struct State {
    Vector3d e;
    VolumeView view;
    double gap, slope, bend;  // and its derivatives by the angle around the axis
  };

  State at(ShapeQuery& q, const Vector3d& e, int hint) const {
    const Vector3d n = -(cos_ * e + sin_ * axis_);
    State x{e, viewVolume(q.body, n, hint, q.steps), 0, 0, 0};
    const Vector3d turning = -cos_ * axis_.cross(e);
    const Vector3d difference = apex_ - x.view.point;
    x.gap = x.view.gap(apex_);
    x.slope = turning.dot(difference);
    x.bend = cos_ * e.dot(difference) - turning.dot(curvatureRadii(q.body, x.view) * turning);
    return x;
  }
  static bool better(const ShapeQuery& q, const State& y, const State& x) {
    return y.gap > x.gap || (std::abs(y.slope) < 0.5 * std::abs(x.slope) && y.gap >= x.gap - q.rounding.gap);
  }
  Vector3d turned(const Vector3d& e, double angle) const {
    const Vector3d m = std::cos(angle) * e + std::sin(angle) * axis_.cross(e);
    return (m - m.dot(axis_) * axis_).normalized();
  }

  Vector3d apex_, axis_;
  double slant_, cos_ = 1, sin_ = 0;
};

/// The rim of a disc, nearest point and normal. Where the normal is all but the axis the point along the rim
/// is rounding, so it is taken from the body's point.
Nearest nearestOnRim(ShapeQuery& q, const Vector3d& middle, const Vector3d& axis, const StartNormal& start) {
  // On the axis every point of the rim is as far, so no gradient leads away: start towards the body's side.
  StartNormal from = start;
  constexpr double kOnAxis = 1e-6, kTilt = 1e-3;
  if ((start.n - start.n.dot(axis) * axis).norm() < kOnAxis) {
    const Vector3d up = viewVolume(q.body, start.n, start.patch, q.steps).point - middle;
    const Vector3d out = up - up.dot(axis) * axis;
    if (out.norm() > 0.0) from.n = (start.n - kTilt * out.normalized()).normalized();
  }
  Nearest found = nearestOn(q, RimFeature{middle, axis, q.shape.radius}, from);
  constexpr double kNearAxis = 1e-4;  // sine; rounding of the normal is then a thousand times that of a point
  const Vector3d side = found.n - found.n.dot(axis) * axis;
  if (!found.apart || side.norm() > kNearAxis) return found;
  const Vector3d up = viewVolume(q.body, found.n, found.patch, q.steps).point - middle;
  const Vector3d out = up - up.dot(axis) * axis;
  const double length = out.norm();
  if (!(length > 0.0)) return found;
  // Inside the disc where that is as near to the plane of the normal as the rim is.
  const bool inside =
      length < q.shape.radius && (q.shape.radius - length) * side.norm() < 0.5 * q.rounding.gap;
  found.y = middle + (inside ? 1.0 : q.shape.radius / length) * out;
  return found;
}

/// A disc from outside its plane, on the side `n` points from: its inside, or its rim. Above the plane of a
/// flat end nothing but that end can be nearest.
Nearest nearestOnDisc(ShapeQuery& q, const Nearest& plane, const Vector3d& middle) {
  const Vector3d out = plane.y - middle;
  const double beyond = out.norm();
  if (beyond <= q.shape.radius) return plane;
  // From the body's point to the rim's nearest one: a good first guess, and often already a gap.
  const Vector3d point = plane.y - plane.gap * plane.n;
  const Vector3d rim = middle + (q.shape.radius / beyond) * out;
  const Vector3d n = (rim - point).normalized();
  return nearestOnRim(q, middle, plane.n, {n, plane.patch});
}

}  // namespace

Nearest nearestOnCylinder(ShapeQuery& q, const StartNormal& start) {
  const Vector3d axis = q.rotation.col(2);
  const Vector3d top = q.translation + q.shape.half * axis, bottom = q.translation - q.shape.half * axis;
  for (const bool up : {true, false}) {
    const Nearest plane = nearestOnPlane(q, up ? top : bottom, up ? Vector3d(-axis) : axis, -1);
    if (plane.apart) return nearestOnDisc(q, plane, up ? top : bottom);
  }
  // The side: the axis with a ball of the rim's radius around it. Along the axis the distance is convex, so a
  // nearest height beyond an end means that end.
  Nearest found = nearestOnSegment(q, bottom, top, start);
  if (found.corners == 2 && found.gap > q.shape.radius) {
    found.gap -= q.shape.radius;
    found.y -= q.shape.radius * found.n;
    return found;
  }
  // No plane of an end or of the side lies between the bodies; at a rim one still may.
  Nearest best;
  for (const bool up : {found.n.dot(axis) < 0.0, !(found.n.dot(axis) < 0.0)}) {
    const Nearest rim = nearestOnRim(q, up ? top : bottom, axis, {found.n, found.patch});
    if (certified(q, rim)) return rim;
    if (rim.apart && (!best.apart || rim.gap > best.gap)) best = rim;
  }
  return best;
}

Nearest nearestOnCone(ShapeQuery& q, const StartNormal& start) {
  const Vector3d axis = q.rotation.col(2);
  const Vector3d apex = q.translation + q.shape.half * axis, base = q.translation - q.shape.half * axis;
  const Nearest plane = nearestOnPlane(q, base, axis, -1);
  if (plane.apart) return nearestOnDisc(q, plane, base);
  const Nearest top = nearestOn(q, PointFeature{apex}, start);
  if (certified(q, top)) return top;
  const StartNormal next = top.apart ? StartNormal{top.n, top.patch} : start;
  const ConeSide side(apex, axis, q.shape.radius, 2.0 * q.shape.half);
  Nearest found = side.nearest(q, next);
  if (certified(q, found)) return found;
  const Nearest rim = nearestOnRim(q, base, axis, next);
  if (certified(q, rim)) return rim;
  if (rim.apart) {
    found = side.nearest(q, {rim.n, rim.patch});
    if (certified(q, found)) return found;
  }
  return rim;
}

}  // namespace fcl_stpbv
