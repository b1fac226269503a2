// How long two moving bodies certainly stay apart: the one bound under every
// proof about a motion (docs/motion.md).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace fcl_stpbv::detail {

/// How a body moves now, per unit of time, in a frame that any plane between
/// two bodies is fixed to; world axes.
struct BodyVelocity {
  Eigen::Vector3d linear{0, 0, 0};  ///< of the point `about` (planeCover), as if the body carried it
  Eigen::Vector3d angular{0, 0, 0};
  double acceleration = 0;  ///< no point of the body is ever accelerated by more
  bool steady = false;      ///< `angular` never changes its direction: all accelerations are across it

  /// No point of the body is ever accelerated by more along the unit vector `n`.
  double accelerationAlong(const Eigen::Vector3d& n) const {
    const double turn = angular.norm();
    if (!steady || !(turn > 0)) return acceleration;
    constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();  // of the sine
    return acceleration * std::min(1.0, n.cross(angular).norm() / turn + kRounding);
  }
};

/// Time before and after now for which two bodies certainly stay farther apart than a margin.
struct Cover {
  double before = 0, after = 0;
};

/// Of two that both hold for the same bodies.
inline Cover longer(const Cover& p, const Cover& q) {
  return {std::max(p.before, q.before), std::max(p.after, q.after)};
}

/// The longest time up to `most` for which `gap + rate t - acceleration t^2 / 2`
/// stays above 0 with the rate at most 0. Of what is no number: 0.
inline double timeAbove(double gap, double rate, double acceleration, double most) {
  if (!(gap > 0) || std::isnan(rate) || std::isnan(acceleration)) return 0;
  const double k = std::min(rate, 0.0);
  if (gap + k * most - 0.5 * acceleration * most * most > 0) return most;
  const double root = std::sqrt(k * k + 2 * acceleration * gap);
  return std::min(most, 2 * gap / (root - k));  // the positive root, without cancellation
}

/// From the plane of unit normal `n` (from a to b) between two convex bodies.
///
/// `supportA(d)` is the largest d.(x - about) over the body, `d` of any length; `gap` is the bodies' gap
/// along `n` less the margin, all bounds less `slack` for rounding. A point x moves along n by t n.v(x) to
/// within acceleration t^2/2, and n.v(x) is linear in x: the least over a body of n.x + t n.v(x) is a support
/// value, concave in t, so that both ends of a time bound all between.
template <class SupportA, class SupportB>
Cover planeCover(const Eigen::Vector3d& n, double gap, const SupportA& supportA, const BodyVelocity& a,
                 const SupportB& supportB, const BodyVelocity& b, double most, double slack) {
  gap -= slack;
  if (!(gap > 0)) return {};
  const Eigen::Vector3d turnA = n.cross(a.angular), turnB = n.cross(b.angular);
  const double along = n.dot(b.linear - a.linear),
               acceleration = a.accelerationAlong(n) + b.accelerationAlong(n);
  const double now = -supportB(Eigen::Vector3d(-n)) - supportA(n);
  // What the velocities alone make of the gap after a time, against now.
  const auto rate = [&](double t) {
    const double then =
        t * along - supportB(Eigen::Vector3d(-n - t * turnB)) - supportA(Eigen::Vector3d(n + t * turnA));
    return (then - now - 2 * slack) / std::abs(t);
  };
  const auto cover = [&](double sign) {
    const double first = timeAbove(gap, rate(sign * most), acceleration, most);
    if (first >= most || first <= 0) return first;
    // Once more over a shorter time: the bound bends down with it.
    const double shorter = std::min(most, 2 * first);
    return std::max(first, timeAbove(gap, rate(sign * shorter), acceleration, shorter));
  };
  return {cover(-1), cover(1)};
}

/// Of any two bodies within balls around points that move so: from their speed alone, `gap` a bound on the
/// distance less the margin.
inline Cover speedCover(double gap, double speed, double acceleration, double most, double slack) {
  const double time = timeAbove(gap - slack, -speed, acceleration, most);
  return {time, time};
}

}  // namespace fcl_stpbv::detail
