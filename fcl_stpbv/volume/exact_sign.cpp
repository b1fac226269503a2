// Exact signs, in these steps:
//  1. Doubles are integers times powers of two. All coordinates and the radius are scaled to integers.
//  2. Let u = b - a, v = c - a, N = u x v. The ball's outward normal at a, multiplied by 2 |N|^2 rho, is
//     sqrt(D) N - T with the integers
//       T = |u|^2 v x N + |v|^2 N x u
//       D = 4 |N|^2 rho^2 - |u|^2 |v|^2 |u - v|^2
//     (docs/theory.md, 2). So both predicates have the form A + B sqrt(D).
//  3. If A and B differ in sign, the comparison of A^2 with B^2 D decides.
// The most frequent case is corners of flat faces. There B = 0, and A is small enough for integers of a fixed
// size. D < 0 means that rounding has made the ball too small. D then counts as 0, which is the ball with the
// three points on a great circle.
#include "fcl_stpbv/volume/exact_sign.h"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace fcl_stpbv::detail {
namespace {

namespace integers = boost::multiprecision;
using Integer = integers::number<integers::cpp_int_backend<>, integers::et_off>;
constexpr int kFixedBits = 512;
using FixedInteger = integers::number<
    integers::cpp_int_backend<kFixedBits, kFixedBits, integers::signed_magnitude, integers::unchecked, void>,
    integers::et_off>;

template <class Int>
struct IntegerVector {
  Int x, y, z;
};
template <class Int>
IntegerVector<Int> operator-(const IntegerVector<Int>& p, const IntegerVector<Int>& q) {
  return {p.x - q.x, p.y - q.y, p.z - q.z};
}
template <class Int>
IntegerVector<Int> operator+(const IntegerVector<Int>& p, const IntegerVector<Int>& q) {
  return {p.x + q.x, p.y + q.y, p.z + q.z};
}
template <class Int>
IntegerVector<Int> operator*(const Int& s, const IntegerVector<Int>& p) {
  return {s * p.x, s * p.y, s * p.z};
}
template <class Int>
Int dot(const IntegerVector<Int>& p, const IntegerVector<Int>& q) {
  return p.x * q.x + p.y * q.y + p.z * q.z;
}
template <class Int>
IntegerVector<Int> cross(const IntegerVector<Int>& p, const IntegerVector<Int>& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

// A double is an odd integer times a power of two.
struct Odd {
  std::int64_t factor;
  int exponent;
  int bits;  // number of bits of the factor

  explicit Odd(double value) {  // `value` must not be 0
    constexpr int kDigits = std::numeric_limits<double>::digits;
    factor = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), kDigits));
    exponent -= kDigits, bits = kDigits;
    const int zeros = __builtin_ctzll(static_cast<unsigned long long>(factor));
    factor /= std::int64_t{1} << zeros, exponent += zeros, bits -= zeros;
  }
};

// Scales doubles to integers, by one power of two for all.
class Scale {
 public:
  void include(double value) {
    if (value == 0 || !std::isfinite(value)) return;
    const Odd odd(value);
    least_ = std::min(least_, odd.exponent);
    most_ = std::max(most_, odd.exponent + odd.bits);
  }
  void include(const Eigen::Vector3d& p) {
    for (int k = 0; k < 3; ++k) include(p[k]);
  }
  // Number of bits of the largest integer.
  int bits() const { return std::max(most_ - least_, 0); }

  template <class Int>
  Int of(double value) const {
    if (value == 0) return 0;
    const Odd odd(value);
    return Int(odd.factor) << (odd.exponent - least_);
  }
  template <class Int>
  IntegerVector<Int> of(const Eigen::Vector3d& p) const {
    return {of<Int>(p.x()), of<Int>(p.y()), of<Int>(p.z())};
  }

 private:
  int least_ = std::numeric_limits<double>::max_exponent;
  int most_ = std::numeric_limits<double>::min_exponent - std::numeric_limits<double>::digits;
};

// Sign of A + B sqrt(D).
int signOf(const Integer& a, const Integer& b, const Integer& d) {
  const int signA = a.sign(), signB = d.sign() > 0 ? b.sign() : 0;
  if (signA * signB >= 0) return signA != 0 ? signA : signB;
  const int larger = (a * a - b * b * d).sign();
  return larger == 0 ? 0 : larger > 0 ? signA : signB;
}

// Data that all balls through three points share, whatever their radius.
template <class Int>
struct Circle {
  IntegerVector<Int> a, u, v, normal;  // the normal is N

  Circle(const BallPoints& ball, const Scale& scale)
      : a(scale.of<Int>(ball.a)),
        u(scale.of<Int>(ball.b) - a),
        v(scale.of<Int>(ball.c) - a),
        normal(cross(u, v)) {}

  Int n2() const { return dot(normal, normal); }
  IntegerVector<Int> towards() const {  // T
    return dot(u, u) * cross(v, normal) + dot(v, v) * cross(normal, u);
  }
  // A for the point a + q.
  Int outside(const IntegerVector<Int>& q) const { return n2() * dot(q, q) - dot(q, towards()); }
  // D for the radius rho.
  Int discriminant(const Int& rho) const {
    const IntegerVector<Int> w = u - v;
    return 4 * n2() * rho * rho - dot(u, u) * dot(v, v) * dot(w, w);
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

std::optional<int> coplanarSide(const BallPoints& points, const Eigen::Vector3d& p) {
  Scale scale;
  for (const Eigen::Vector3d& x : {points.a, points.b, points.c, p}) scale.include(x);
  // A is a sum of fewer than 128 products of six differences. Each difference has one bit more than a
  // coordinate.
  if (6 * (scale.bits() + 1) + 7 > kFixedBits) return std::nullopt;
  const Circle<FixedInteger> circle(points, scale);
  const IntegerVector<FixedInteger> q = scale.of<FixedInteger>(p) - circle.a;
  if (dot(q, circle.normal) != 0) return std::nullopt;
  return circle.outside(q).sign();
}

int exactSide(const BallPoints& points, const Eigen::Vector3d& p) {
  const Scale scale = scaleOf(points, {p});
  const Circle<Integer> circle(points, scale);
  const IntegerVector<Integer> q = scale.of<Integer>(p) - circle.a;
  const Integer up = dot(q, circle.normal);
  if (std::isinf(points.radius)) return up.sign();
  return signOf(circle.outside(q), up, circle.discriminant(scale.of<Integer>(points.radius)));
}

int exactTurn(const BallPoints& points, const Eigen::Vector3d& p, const Eigen::Vector3d& q,
              const Eigen::Vector3d& s) {
  const Scale scale = scaleOf(points, {p, q, s});
  const Circle<Integer> circle(points, scale);
  const IntegerVector<Integer> at = scale.of<Integer>(p),
                               around = cross(scale.of<Integer>(q) - at, scale.of<Integer>(s) - at);
  const Integer up = dot(around, circle.normal);
  if (std::isinf(points.radius)) return up.sign();
  return signOf(dot(around, 2 * circle.n2() * (at - circle.a) - circle.towards()), up,
                circle.discriminant(scale.of<Integer>(points.radius)));
}

}  // namespace fcl_stpbv::detail
