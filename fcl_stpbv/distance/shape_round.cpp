// The nearest point of a cylinder, a cone or an ellipsoid to an STP-BV's core. Of the first two feature by
// feature; the first with a certificate is the answer:
// 1. beyond a flat end: its disc, inside or at the rim;
// 2. the side: a segment with the radius around it, or the generators of a cone, by Newton's method on the
//    angle around the axis, safeguarded by the Illinois variant of regula falsi;
// 3. the rims, by Newton's method on the same angle.
#include <algorithm>
#include <cmath>

#include "fcl_stpbv/distance/shape_query.h"

namespace fcl_stpbv::detail {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// The side of a cone. Its normals form a small circle, and the supporting planes of all of them contain the
/// apex. So the gap is that of the apex, and its slope tells on which generator the nearest point lies.
class ConeSide {
 public:
  ConeSide(const Vector3d& apex, const Vector3d& axis, double radius, double height)
      : apex_(apex), axis_(axis), slant_(std::hypot(radius, height)) {
    if (!(slant_ > 0.0)) return;  // a point
    cos_ = height / slant_;
    sin_ = radius / slant_;
  }

  /// Newton's method on the angle around the axis, from the side that faces `n`.
  Nearest nearest(ShapeQuery& q, const StartNormal& start) const {
    constexpr int kSteps = 40;
    State x = at(q, acrossLine(-start.n, axis_), start.patch);
    Nearest found;
    for (int i = 0; i < kSteps; ++i) {
      ++q.pairs;
      if (std::abs(x.slope) <= 0.25 * q.rounding.across * cos_) break;
      double turn = x.curvature < 0.0 ? -x.slope / x.curvature : std::copysign(0.5, x.slope);
      turn = std::clamp(turn, -1.0, 1.0);
      State y = at(q, turned(x.e, turn), x.view.patch);
      // Past a region boundary Newton's step may overshoot. The slope is continuous, so it has a zero in
      // between.
      if (!better(q, y, x) && x.slope * y.slope < 0.0) y = between(q, x, y, turn);
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
    found.apart = found.gap > 0.0 && along >= 0.0 && along <= slant_;
    // Rounding may put the point beside the generator: project it back.
    if (found.apart) found.y = apex_ + along * generator;
    return found;
  }

 private:
  struct State {
    Vector3d e;
    SupportPoint view;
    double gap, slope, curvature;  // and its derivatives by the angle around the axis
  };

  State at(ShapeQuery& q, const Vector3d& e, int hint) const {
    const Vector3d n = -(cos_ * e + sin_ * axis_);
    State x{e, viewVolume(q.body, n, hint, q.steps), 0, 0, 0};
    const Vector3d turning = -cos_ * axis_.cross(e);
    const Vector3d difference = apex_ - x.view.point;
    x.gap = x.view.gap(apex_);
    x.slope = turning.dot(difference);
    x.curvature = cos_ * e.dot(difference) - turning.dot(curvatureRadii(q.body, x.view) * turning);
    return x;
  }
  /// The zero of the slope between `x` and `y`, which is `turn` away, by the Illinois method.
  State between(ShapeQuery& q, const State& x, const State& y, double turn) const {
    double low = 0.0, high = turn, lowWeight = x.slope, highWeight = y.slope;
    State best = std::abs(x.slope) < std::abs(y.slope) ? x : y;
    int last = 0;
    for (int k = 0; k < 60 && std::abs(best.slope) > 0.25 * q.rounding.across * cos_; ++k) {
      const double angle = low + (high - low) * lowWeight / (lowWeight - highWeight);
      const State middle = at(q, turned(x.e, angle), best.view.patch);
      if (std::abs(middle.slope) < std::abs(best.slope)) best = middle;
      const int side = middle.slope * x.slope > 0.0 ? 1 : -1;
      (side > 0 ? low : high) = angle;
      (side > 0 ? lowWeight : highWeight) = middle.slope;
      if (side == last) (side > 0 ? highWeight : lowWeight) *= 0.5;
      last = side;
    }
    return best;
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

/// The rim's nearest point, by Newton's method on the angle around the axis. If the normal is almost along
/// the axis, it does not determine the point of the rim. But the distance to a given point of the rim, and
/// its normal, are accurate.
Nearest nearestByAngle(ShapeQuery& q, const Vector3d& middle, const Vector3d& axis,
                       const StartNormal& start) {
  constexpr int kSteps = 20;
  const Vector3d up = viewVolume(q.body, start.n, start.patch, q.steps).point - middle;
  Vector3d e = up - up.dot(axis) * axis;
  if (!(e.norm() > 0.0)) return {};
  e.normalize();
  const double radius = q.shape.radius;
  Nearest best;
  double flattest = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const StartNormal from = best.apart ? StartNormal{best.n, best.patch} : start;
    const Nearest found = nearestOn(q, PointFeature{middle + radius * e}, from);
    if (!found.apart) break;
    const Vector3d t = axis.cross(e), &n = found.n;
    const double slope = n.dot(t);
    if (best.apart && !(std::abs(slope) < flattest)) break;  // rounding
    best = found;
    flattest = std::abs(slope);
    // The normal turns by the inverse of the sum of the radii of curvature and the gap.
    Matrix3d w = curvatureRadii(q.body, viewVolume(q.body, n, found.patch, q.steps));
    w += found.gap * Matrix3d::Identity();
    const Vector3d e1 = (t - t.dot(n) * n).normalized(), e2 = n.cross(e1);
    const double m11 = e1.dot(w * e1), m22 = e2.dot(w * e2), m12 = e1.dot(w * e2);
    const double curvature = radius * t.dot(e1) * t.dot(e1) * m22 / (m11 * m22 - m12 * m12) - n.dot(e);
    if (!(curvature > 0.0)) break;
    const double turn = std::clamp(-slope / curvature, -0.5, 0.5);
    e = (std::cos(turn) * e + std::sin(turn) * t).normalized();
  }
  return best;
}

/// The nearest point of a disc's rim, and the normal there.
Nearest nearestOnRim(ShapeQuery& q, const Vector3d& middle, const Vector3d& axis, const StartNormal& start) {
  // Along the axis the gradient is zero by symmetry, so start a little towards the body's side.
  StartNormal from = start;
  constexpr double kOnAxis = 1e-6, kTilt = 1e-3;
  if ((start.n - start.n.dot(axis) * axis).norm() < kOnAxis) {
    const Vector3d up = viewVolume(q.body, start.n, start.patch, q.steps).point - middle;
    const Vector3d out = up - up.dot(axis) * axis;
    if (out.norm() > 0.0) from.n = (start.n - kTilt * out.normalized()).normalized();
  }
  const Nearest found = nearestOn(q, RimFeature{middle, axis, q.shape.radius}, from);
  constexpr double kNearAxis =
      0.1;  // sine: here the normal's rounding moves the point by ten times as much, nearer the axis by more
  if ((found.n - found.n.dot(axis) * axis).norm() > kNearAxis) return found;
  const Nearest refined = nearestByAngle(q, middle, axis, {found.n, found.patch});
  return refined.apart ? refined : found;
}

/// The nearest point of a flat end, on its inside or its rim, for a body above the end's plane. Only that end
/// can be nearest then.
Nearest nearestOnDisc(ShapeQuery& q, const Nearest& plane, const Vector3d& middle) {
  const Vector3d out = plane.y - middle;
  const double beyond = out.norm();
  if (beyond <= q.shape.radius) return plane;
  // The direction from the body's point to the nearest point of the rim is a good start, and often has a gap.
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
  // The side: the axis with the radius around it. The distance is convex along the axis. So if the nearest
  // height is beyond an end, the end is nearest.
  Nearest found = nearestOnSegment(q, bottom, top, start);
  if (found.corners == 2 && found.gap > q.shape.radius) {
    found.gap -= q.shape.radius;
    found.y -= q.shape.radius * found.n;
    return found;
  }
  // No supporting plane of an end or of the side separates the bodies. One at a rim may.
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
  Nearest found = nearestOnGenerator(q, next);
  if (certified(q, found)) return found;
  const Nearest rim = nearestOnRim(q, base, axis, next);
  if (certified(q, rim)) return rim;
  if (rim.apart) {
    found = nearestOnGenerator(q, {rim.n, rim.patch});
    if (certified(q, found)) return found;
  }
  return rim;
}

Nearest nearestOnGenerator(ShapeQuery& q, const StartNormal& start) {
  const Vector3d axis = q.rotation.col(2);
  return ConeSide(q.translation + q.shape.half * axis, axis, q.shape.radius, 2.0 * q.shape.half)
      .nearest(q, start);
}

PosedEllipsoid::PosedEllipsoid(const ShapeQuery& q)
    : whole{q.translation, q.rotation * q.shape.size.asDiagonal()} {
  const double least = q.shape.size.minCoeff(&shortest), most = q.shape.size.maxCoeff(&longest);
  isSegment = q.shape.size.sum() - most <= q.rounding.gap;
  isDisc = !isSegment && least <= q.rounding.gap;
}

double besideEllipsoid(const ShapeQuery& q, const Vector3d& y) {
  const Vector3d at = q.rotation.transpose() * (y - q.translation), &axes = q.shape.size;
  double flat = 0.0, level2 = 0.0, slope2 = 0.0;
  for (int i = 0; i < 3; ++i) {
    if (axes[i] > q.rounding.gap) {
      level2 += at[i] / axes[i] * (at[i] / axes[i]);
      slope2 += at[i] / axes[i] / axes[i] * (at[i] / axes[i] / axes[i]);
    } else {
      flat = std::max(flat, std::abs(at[i]) - axes[i]);
    }
  }
  const double level = std::sqrt(level2);
  return std::max(flat, level > 1.0 ? (level - 1.0) * level / std::sqrt(slope2) : 0.0);
}

void placeOppositeOnEllipsoid(ShapeQuery& q, Nearest& found) {
  const Vector3d point = viewVolume(q.body, found.n, found.patch, q.steps).point;
  const Vector3d opposite = point + found.n.dot(found.y - point) * found.n;
  if (besideEllipsoid(q, opposite) <= q.rounding.gap) found.y = opposite;
}

Nearest nearestOnEllipsoid(ShapeQuery& q, const StartNormal& start) {
  const PosedEllipsoid e(q);
  if (e.isSegment) {
    const Vector3d axis = e.whole.axes.col(e.longest);
    return nearestOnSegment(q, q.translation - axis, q.translation + axis, start);
  }
  if (e.isDisc) {
    const Vector3d normal = q.rotation.col(e.shortest);
    for (const Vector3d& n : {normal, Vector3d(-normal)}) {
      const Nearest plane = nearestOnPlane(q, q.translation, n, -1);
      if (plane.apart && besideEllipsoid(q, plane.y) <= q.rounding.gap) return plane;
    }
  }
  Nearest found = nearestOn(q, e.whole, start);
  if (e.whole.wobble(found.n) > q.rounding.across) placeOppositeOnEllipsoid(q, found);
  return found;
}

}  // namespace fcl_stpbv::detail
