// Decides whether a point is inside or outside of the ball through three other points. It computes the sign
// of the point's height over the ball, |q|^2 / (2 rho) + q.m. Here q is the vector to the point from one of
// the three, and m is the ball's normal there. The sign is computed
// 1. in long double, if the height is above its error bound;
// 2. in quadruple precision, if the height is above the error bound of that;
// 3. exactly, in integers (exact_sign.h).
#include "fcl_stpbv/volume/ball_side.h"

#include <cmath>
#include <limits>

#include "fcl_stpbv/volume/exact_sign.h"

namespace fcl_stpbv::detail {
namespace {

#ifdef __SIZEOF_FLOAT128__
__extension__ typedef __float128 Quad;
#else
using Quad = long double;  // already 113 bits on the platforms without __float128
#endif

constexpr double kQuadEpsilon = 1e-33;  // 2^-112 = 1.9e-34, rounded up generously
constexpr double kQuadRoot = 3e-17;     // its square root
static_assert(std::numeric_limits<long double>::digits >= 64, "a long double must hold 64 bits or more");
constexpr double kQuadMargin = 64;  // for the constants of the error bound
constexpr double kLongEpsilon =
    std::numeric_limits<long double>::epsilon() * 8;  // for about a dozen roundings in a formula

template <class T>
struct Vec {
  T x, y, z;
};
template <class T>
Vec<T> difference(const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
  return {T(p.x()) - T(q.x()), T(p.y()) - T(q.y()), T(p.z()) - T(q.z())};
}
template <class T>
T dot(const Vec<T>& a, const Vec<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
Vec<T> cross(const Vec<T>& a, const Vec<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
Vec<T> combine(T s, const Vec<T>& a, T t, const Vec<T>& b) {
  return {s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z};
}

long double squareRoot(long double x) { return std::sqrt(x); }
#ifdef __SIZEOF_FLOAT128__
Quad squareRoot(Quad x) {
  if (x <= 0) return 0;
  Quad y = std::sqrt(static_cast<long double>(x));
  y = (y + x / y) / 2;  // 64 bits become 113 in one Newton step
  return (y + x / y) / 2;
}
#endif

// Outward normal at a of the ball through a, a+u, a+v. `condition` is the factor by which it magnifies
// rounding. With N = u x v and O the circumcentre relative to a: m = -kappa O + sqrt(1 - kappa^2 O^2) N/|N|.
// Where this root is small, it is off by the rounding of its square divided by itself, but at most by the
// square root of that rounding. If the sine of the triangle's angle is below `leastSine`, the cross product
// is only rounding, and the points count as collinear.
template <class T>
bool ballNormal(const Vec<T>& u, const Vec<T>& v, T kappa, double leastSine, Vec<T>* m, double* condition) {
  const Vec<T> n = cross(u, v);
  const T n2 = dot(n, n), u2 = dot(u, u), v2 = dot(v, v);
  const double sine = std::sqrt(static_cast<double>(n2 / (u2 * v2)));  // NaN for coinciding points
  if (!(sine > leastSine)) return false;
  const T length = squareRoot(n2);
  const Vec<T> towards = combine(u2, cross(v, n), v2, cross(n, u));
  const T scale = kappa / (2 * n2);
  const Vec<T> o{scale * towards.x, scale * towards.y, scale * towards.z};
  const T rest = 1 - dot(o, o);
  // A ball whose radius equals the circumradius to within rounding still touches the points.
  if (static_cast<double>(rest) < -1e-17 / (sine * sine)) return false;
  const T root = rest > 0 ? squareRoot(rest) : T(0);
  *m = combine(T(-1), o, root / length, n);
  *condition = (1 + 1 / (static_cast<double>(root) + kQuadRoot)) / sine;
  return true;
}

}  // namespace

// Least sines of a triangle's angle. Triangles below kThinLong are decided in quadruple precision, and points
// below kThinQuad count as collinear. Points that are not collinear and whose coordinates are doubles make
// triangles with a far larger sine than kThinQuad.
constexpr double kThinLong = 1e-6, kThinQuad = 1e-24;

struct TouchingBall::Exact {
  bool valid = false;
  double condition = 1;
  Quad kappa;
  Vec<Quad> m;
};

TouchingBall::TouchingBall(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                           double radius)
    : anchor_(a), b_(b), c_(c), radius_(radius) {
  kappa_ = std::isinf(radius) ? 0.0L : 1.0L / static_cast<long double>(radius);
  Vec<long double> m{};
  valid_ = ballNormal(difference<long double>(b, a), difference<long double>(c, a), kappa_, kThinLong, &m,
                      &condition_);
  double error = kLongEpsilon * condition_;
  if (!valid_ || error > 1e-17) {
    const Exact& e = exact();
    valid_ = e.valid;
    if (!valid_) return;
    condition_ = e.condition;
    m = {static_cast<long double>(e.m.x), static_cast<long double>(e.m.y), static_cast<long double>(e.m.z)};
    error = kLongEpsilon + kQuadMargin * kQuadEpsilon * condition_;
  }
  m_[0] = m.x, m_[1] = m.y, m_[2] = m.z;
  normal_ = {static_cast<double>(m.x), static_cast<double>(m.y), static_cast<double>(m.z)};
  normalError_ = error;
}

const TouchingBall::Exact& TouchingBall::exact() const {
  if (!exact_) {
    auto e = std::make_shared<Exact>();
    e->kappa = std::isinf(radius_) ? Quad(0) : Quad(1) / Quad(radius_);
    e->valid = ballNormal(difference<Quad>(b_, anchor_), difference<Quad>(c_, anchor_), e->kappa, kThinQuad,
                          &e->m, &e->condition);
    exact_ = std::move(e);
  }
  return *exact_;
}

Eigen::Vector3d TouchingBall::normalAt(const Eigen::Vector3d& p) const {
  const Vec<long double> q = difference<long double>(p, anchor_);
  const Eigen::Vector3d m(static_cast<double>(m_[0] + kappa_ * q.x),
                          static_cast<double>(m_[1] + kappa_ * q.y),
                          static_cast<double>(m_[2] + kappa_ * q.z));
  return m.normalized();
}

long double TouchingBall::height(const Eigen::Vector3d& p) const {
  const Vec<long double> q = difference<long double>(p, anchor_);
  return kappa_ * dot(q, q) / 2 + (q.x * m_[0] + q.y * m_[1] + q.z * m_[2]);
}

int TouchingBall::side(const Eigen::Vector3d& p) const {
  const double length = (p - anchor_).norm();
  const long double rough = height(p);
  const long double certain = (kLongEpsilon + normalError_) * length;
  if (rough > certain) return 1;
  if (rough < -certain) return -1;
  const Exact& e = exact();
  const Vec<Quad> q = difference<Quad>(p, anchor_);
  const double value = static_cast<double>(e.kappa * dot(q, q) / 2 + dot(q, e.m));
  const double unsure = kQuadMargin * kQuadEpsilon * e.condition * length;
  if (std::abs(value) > unsure) return value > 0 ? 1 : -1;
  return exactSide({anchor_, b_, c_, radius_}, p);
}

int TouchingBall::turn(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& s) const {
  const double size = (q - p).norm() * (s - p).norm();
  {
    const Vec<long double> o = difference<long double>(p, anchor_);
    const Vec<long double> m{m_[0] + kappa_ * o.x, m_[1] + kappa_ * o.y, m_[2] + kappa_ * o.z};
    const long double d = dot(m, cross(difference<long double>(q, p), difference<long double>(s, p)));
    const double certain = (kLongEpsilon + normalError_) * size;
    if (d > certain) return 1;
    if (d < -certain) return -1;
  }
  const Exact& e = exact();
  const Vec<Quad> o = difference<Quad>(p, anchor_);
  const Vec<Quad> m{e.m.x + e.kappa * o.x, e.m.y + e.kappa * o.y, e.m.z + e.kappa * o.z};
  const double d = static_cast<double>(dot(m, cross(difference<Quad>(q, p), difference<Quad>(s, p))));
  const double unsure = kQuadMargin * kQuadEpsilon * e.condition * size;
  if (std::abs(d) > unsure) return d > 0 ? 1 : -1;
  return exactTurn({anchor_, b_, c_, radius_}, p, q, s);
}

}  // namespace fcl_stpbv::detail
