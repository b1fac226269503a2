// Sides of a ball in double precision. With u and v from the anchor to the other points, N = u x v, O the
// circumcentre from the anchor and kappa the curvature, the normal at the anchor is -kappa O + sqrt(1 -
// kappa^2 O^2) N/|N|, and a point at q from the anchor is q.(kappa/2 q + normal) high.
//
// Bounds on the rounding errors, in units e = 2^-53. Let s be the sine of the angle between u and v, and w
// the root above.
// - N is off by at most 10 e / s of its length, because its terms are products of the lengths |u||v|.
// - O = ((u^2 v - v^2 u) x N) / (2 N^2) is off because N is: after the division by 40 e / s of kappa O <= 1.
//   It is also off by the roundings of its two terms, 10 e kappa (|u| + |v|) / (2 s) <= 20 e / s, because u
//   and v are chords.
// - The root of 1 - kappa^2 O^2 is off by the error of kappa O over w, and N/|N| by 20 e / s.
// So the normal is off by at most (60 (1 + 1/w) + 20) e / s. A height is off by |q| times the sum of this and
// 10 e, which is for the height's own sums. Chords are at most 2/kappa long. This holds for q, too, because
// the ball is larger than the smallest one around the cloud.
#include "fcl_stpbv/volume/quick_ball.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/exact_sign.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

QuickBall::QuickBall(const Vector3d& a, const Vector3d& b, const Vector3d& c, double radius)
    : touched_{&a, &b, &c}, radius_(radius) {
  // The anchor is the corner with the largest angle, opposite the longest side: there s is largest.
  const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
  if (ab > bc && ab > ca)
    touched_ = {&c, &a, &b};
  else if (ca > bc)
    touched_ = {&b, &c, &a};
  anchor_ = *touched_[0];
  const double curvature = 1 / radius;
  halfCurvature_ = 0.5 * curvature;
  const Vector3d u = *touched_[1] - anchor_, v = *touched_[2] - anchor_, n = u.cross(v);
  const double u2 = u.squaredNorm(), v2 = v.squaredNorm(), n2 = n.squaredNorm();
  const Vector3d o = curvature / (2 * n2) * (u2 * v.cross(n) + v2 * n.cross(u));
  const double rest = 1 - o.squaredNorm(), sine = std::sqrt(n2 / (u2 * v2));
  constexpr double kThin = 1e-6, kSteep = 1e-4;  // below these the squares of the errors would count
  if (!(sine > kThin && rest > kSteep)) {
    error_ = kInfinity;
    valid_ = exact().valid();
    return;
  }
  valid_ = true;
  const double root = std::sqrt(rest);
  normal_ = root / std::sqrt(n2) * n - o;
  constexpr double kUnit = 0.5 * std::numeric_limits<double>::epsilon();
  error_ = 2 * kUnit * ((60 * (1 + 1 / root) + 20) / sine + 10);  // twice the bound, for safety
}

TouchingBall& QuickBall::exact() {
  if (!exact_) exact_ = std::make_unique<TouchingBall>(*touched_[0], *touched_[1], *touched_[2], radius_);
  return *exact_;
}

int QuickBall::exactSide(const Vector3d& p) {
  for (const Vector3d* touched : touched_)
    if (p == *touched) return 0;
  const std::optional<int> side = coplanarSide({*touched_[0], *touched_[1], *touched_[2], radius_}, p);
  return side ? *side : exact().side(p);
}

}  // namespace fcl_stpbv::detail
