// A lower bound on how long two moving bodies stay apart. All proofs about motions use it (docs/motion.md).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fcl_stpbv/adapter/posed_geometry.h"

namespace fcl_stpbv::detail {

/// The present velocity of a body, per unit of time, relative to the frame to which separating planes are
/// fixed; world axes.
struct BodyVelocity {
  /// Of the point `about` (see planeCover()), as if it were fixed to the body.
  Eigen::Vector3d linear{0, 0, 0};
  Eigen::Vector3d angular{0, 0, 0};
  double acceleration = 0;  ///< upper bound on the acceleration of any point of the body, at any time
  /// `angular` never changes its direction, so all accelerations are perpendicular to it.
  bool steady = false;

  /// Upper bound on the acceleration of any point of the body along the unit vector `n`.
  double accelerationAlong(const Eigen::Vector3d& n) const {
    const double turn = angular.norm();
    if (!steady || !(turn > 0)) return acceleration;
    constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();  // rounding of the sine
    return acceleration * std::min(1.0, n.cross(angular).norm() / turn + kRounding);
  }
};

/// Time before and after now for which two bodies certainly stay farther apart than a margin.
struct Cover {
  double before = 0, after = 0;
};

/// The longer times of two covers that both hold for the same bodies.
inline Cover longer(const Cover& p, const Cover& q) {
  return {std::max(p.before, q.before), std::max(p.after, q.after)};
}

/// The longest time up to `most` for which `gap + rate t - acceleration t^2 / 2` stays above 0. A rate above
/// 0 counts as 0. If the rate or the acceleration is NaN, the time is 0.
inline double timeAbove(double gap, double rate, double acceleration, double most) {
  if (!(gap > 0) || std::isnan(rate) || std::isnan(acceleration)) return 0;
  const double k = std::min(rate, 0.0);
  if (gap + k * most - 0.5 * acceleration * most * most > 0) return most;
  const double root = std::sqrt(k * k + 2 * acceleration * gap);
  return std::min(most, 2 * gap / (root - k));  // the positive root, without cancellation
}

/// The cover that a separating plane of two convex bodies gives; its unit normal `n` points from a to b.
///
/// `supportA(d)` is the largest d.(x - about) over the body, `d` of any length; `gap` is the bodies' gap
/// along `n` less the margin, all bounds less `slack` for rounding. Within the time t, a point x moves along
/// n by t n.v(x), with an error of at most acceleration t^2/2. Since n.v(x) is linear in x, the minimum of
/// n.x + t n.v(x) over a body is a support value. It is concave in t, so its values at both ends of an
/// interval bound it in between.
template <class SupportA, class SupportB>
Cover planeCover(const Eigen::Vector3d& n, double gap, const SupportA& supportA, const BodyVelocity& a,
                 const SupportB& supportB, const BodyVelocity& b, double most, double slack) {
  gap -= slack;
  if (!(gap > 0)) return {};
  const Eigen::Vector3d turnA = n.cross(a.angular), turnB = n.cross(b.angular);
  const double along = n.dot(b.linear - a.linear),
               acceleration = a.accelerationAlong(n) + b.accelerationAlong(n);
  const double now = -supportB(Eigen::Vector3d(-n)) - supportA(n);
  // Mean rate over the time t at which the velocities alone change the gap.
  const auto rate = [&](double t) {
    const double then =
        t * along - supportB(Eigen::Vector3d(-n - t * turnB)) - supportA(Eigen::Vector3d(n + t * turnA));
    return (then - now - 2 * slack) / std::abs(t);
  };
  const auto cover = [&](double sign) {
    const double first = timeAbove(gap, rate(sign * most), acceleration, most);
    if (first >= most || first <= 0) return first;
    // Once more over a shorter time. The bound is concave in time, so its mean rate is better there.
    const double shorter = std::min(most, 2 * first);
    return std::max(first, timeAbove(gap, rate(sign * shorter), acceleration, shorter));
  };
  return {cover(-1), cover(1)};
}

/// The cover from a bound on the speed of approach alone. `gap` is a lower bound on the distance minus the
/// margin.
inline Cover speedCover(double gap, double speed, double acceleration, double most, double slack) {
  const double time = timeAbove(gap - slack, -speed, acceleration, most);
  return {time, time};
}

/// Two moving geometries at one time. An unbounded geometry must not rotate.
struct MovingNow {
  const PosedPair& pair;
  Eigen::Isometry3d pose;  ///< pose of the first geometry
  Eigen::Vector3d normal;  ///< unit normal of the present distance, from the first geometry to the second
  std::array<Eigen::Vector3d, 2> point;  ///< witness points of the present distance
  Eigen::Vector3d about;  ///< a point between the witness points, to which the velocities refer
  std::array<BodyVelocity, 2> velocity;
  /// Upper bound on the speed at which any two points of the geometries approach now (m per unit of time).
  double speed;
  double acceleration;  ///< upper bound on the growth of that speed per unit of time
  double margin;
  double slack;  ///< allowance for rounding in a gap (m)
};

/// The time, up to `most`, for which planes between their elements keep the geometries apart. At least
/// `known`, a time that is already known to hold for any two elements.
Cover elementCover(const MovingNow& now, double most, const Cover& known);

}  // namespace fcl_stpbv::detail
