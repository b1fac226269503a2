// Exact signs, in these steps:
//  1. Doubles are integers times powers of two. All coordinates and the radius are scaled to integers.
//  2. Multiplied by 2 |N|^2 rho (u = b - a, v = c - a, N = u x v), the ball's outward normal at a is
//     sqrt(D) N - T with the integers T = |u|^2 v x N + |v|^2 N x u and D = 4 |N|^2 rho^2 - |u|^2 |v|^2 |u -
//     v|^2 (docs/theory.md, 2). So both predicates have the form A + B sqrt(D).
//  3. Where A and B differ in sign, A^2 against B^2 D decides.
// D < 0, a ball too small by rounding, counts as 0: the ball around the three points' own circle.
#include "fcl_stpbv/volume/exact_sign.h"

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

namespace fcl_stpbv::detail {
namespace {

using Integer = boost::multiprecision::cpp_int;

struct IntegerVector {
  Integer x, y, z;
};
IntegerVector operator-(const IntegerVector& p, const IntegerVector& q) {
  return {p.x - q.x, p.y - q.y, p.z - q.z};
}
IntegerVector operator+(const IntegerVector& p, const IntegerVector& q) {
  return {p.x + q.x, p.y + q.y, p.z + q.z};
}
IntegerVector operator*(const Integer& s, const IntegerVector& p) { return {s * p.x, s * p.y, s * p.z}; }
Integer dot(const IntegerVector& p, const IntegerVector& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }
IntegerVector cross(const IntegerVector& p, const IntegerVector& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

// The exponent of a double's last bit; that of its last bit that is set is not needed.
int lastBit(double value) {
  int exponent = 0;
  std::frexp(value, &exponent);
  return exponent - std::numeric_limits<double>::digits;
}

// Scales doubles to integers, by one power of two for all.
class Scale {
 public:
  void include(double value) {
    if (value != 0 && std::isfinite(value)) least_ = std::min(least_, lastBit(value));
  }
  void include(const Eigen::Vector3d& p) {
    for (int k = 0; k < 3; ++k) include(p[k]);
  }
  Integer operator()(double value) const {
    if (value == 0) return 0;
    const int last = lastBit(value);
    return Integer(static_cast<std::int64_t>(std::ldexp(value, -last))) << (last - least_);
  }
  IntegerVector operator()(const Eigen::Vector3d& p) const {
    return {(*this)(p.x()), (*this)(p.y()), (*this)(p.z())};
  }

 private:
  int least_ = std::numeric_limits<double>::max_exponent;
};

// Sign of A + B sqrt(D).
int signOf(const Integer& a, const Integer& b, const Integer& d) {
  const int signA = a.sign(), signB = d.sign() > 0 ? b.sign() : 0;
  if (signA * signB >= 0) return signA != 0 ? signA : signB;
  const int larger = Integer(a * a - b * b * d).sign();
  return larger == 0 ? 0 : larger > 0 ? signA : signB;
}

struct IntegerBall {
  IntegerVector a, normal, towards;  // N and T
  Integer n2, discriminant;
  bool isPlane;

  IntegerBall(const BallPoints& ball, const Scale& scale)
      : a(scale(ball.a)), isPlane(std::isinf(ball.radius)) {
    const IntegerVector u = scale(ball.b) - a, v = scale(ball.c) - a, w = u - v;
    normal = cross(u, v);
    if (isPlane) return;
    const Integer u2 = dot(u, u), v2 = dot(v, v), rho = scale(ball.radius);
    n2 = dot(normal, normal);
    towards = u2 * cross(v, normal) + v2 * cross(normal, u);
    discriminant = 4 * n2 * rho * rho - u2 * v2 * dot(w, w);
  }
};

Scale scaleOf(const BallPoints& ball, std::initializer_list<Eigen::Vector3d> others) {
  Scale scale;
  for (const Eigen::Vector3d& p : {ball.a, ball.b, ball.c}) scale.include(p);
  for (const Eigen::Vector3d& p : others) scale.include(p);
  scale.include(ball.radius);
  return scale;
}

}  // namespace

int exactSide(const BallPoints& points, const Eigen::Vector3d& p) {
  const Scale scale = scaleOf(points, {p});
  const IntegerBall ball(points, scale);
  const IntegerVector q = scale(p) - ball.a;
  if (ball.isPlane) return dot(q, ball.normal).sign();
  return signOf(ball.n2 * dot(q, q) - dot(q, ball.towards), dot(q, ball.normal), ball.discriminant);
}

int exactTurn(const BallPoints& points, const Eigen::Vector3d& p, const Eigen::Vector3d& q,
              const Eigen::Vector3d& s) {
  const Scale scale = scaleOf(points, {p, q, s});
  const IntegerBall ball(points, scale);
  const IntegerVector at = scale(p), around = cross(scale(q) - at, scale(s) - at);
  const Integer up = dot(around, ball.normal);
  if (ball.isPlane) return up.sign();
  return signOf(dot(around, 2 * ball.n2 * (at - ball.a) - ball.towards), up, ball.discriminant);
}

bool spanPlane(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const IntegerBall plane({a, b, c, std::numeric_limits<double>::infinity()},
                          scaleOf({a, b, c, std::numeric_limits<double>::infinity()}, {}));
  return plane.normal.x != 0 || plane.normal.y != 0 || plane.normal.z != 0;
}

}  // namespace fcl_stpbv::detail
