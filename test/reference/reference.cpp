#include "test/reference/reference.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "test/reference/normal_polygon.h"

namespace fcl_stpbv::test {

namespace {

/// The lowest centre along `n` whose ball of radius `rho` holds these one, two or three points, all on its
/// surface; false when there is none.
bool lowestCentre(const std::vector<Vector3L>& p, const Vector3L& n, long double rho, Vector3L& centre) {
  if (p.size() == 1) {
    centre = p[0] - rho * n;
    return true;
  }
  if (p.size() == 2) {
    const Vector3L half = (p[1] - p[0]) / 2;
    const Vector3L u = half.normalized();
    const long double kappa2 = (rho - half.norm()) * (rho + half.norm());
    const Vector3L across = n - n.dot(u) * u;
    if (kappa2 < 0 || !(across.norm() > 0)) return false;
    centre = p[0] + half - std::sqrt(kappa2) * across.normalized();
    return true;
  }
  const Vector3L e = p[1] - p[0], f = p[2] - p[0], x = e.cross(f);
  const long double x2 = x.squaredNorm();
  if (!(x2 > 0)) return false;
  const Vector3L c = (f.squaredNorm() * x.cross(e) + e.squaredNorm() * f.cross(x)) / (2 * x2);
  const long double height2 = (rho - c.norm()) * (rho + c.norm());
  if (height2 < 0) return false;
  const Vector3L up = x / std::sqrt(x2);
  centre = p[0] + c - std::sqrt(height2) * (n.dot(up) > 0 ? up : Vector3L(-up));
  return true;
}

/// The lowest feasible centre for a few points: the best over their subsets of at most three, kept in
/// `basis`.
Vector3L solveSmall(std::vector<Vector3L>& basis, const Vector3L& n, long double rho, long double tolerance) {
  const std::vector<Vector3L> all = basis;
  long double lowest = std::numeric_limits<long double>::infinity();
  long double leastMiss = std::numeric_limits<long double>::infinity();
  Vector3L best = all[0];
  for (unsigned subset = 1; subset < (1u << all.size()); ++subset) {
    std::vector<Vector3L> chosen;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (subset >> i & 1u) chosen.push_back(all[i]);
    if (chosen.size() > 3) continue;
    Vector3L centre;
    if (!lowestCentre(chosen, n, rho, centre)) continue;
    long double miss = 0;
    for (const Vector3L& q : all) miss = std::max(miss, (q - centre).norm() - rho);
    // Feasible ones compete in height; should rounding leave none, the one that misses least wins.
    const bool feasible = miss <= tolerance;
    const long double height = n.dot(centre);
    if (feasible ? (leastMiss > tolerance || height < lowest) : miss < leastMiss) {
      best = centre;
      basis = chosen;
      lowest = height;
      leastMiss = miss;
    }
  }
  return best;
}

}  // namespace

ReferenceBody referenceBody(const Cloud& points, double r, double R, const Eigen::Isometry3d& pose) {
  ReferenceBody body;
  body.r = r;
  body.R = R;
  Eigen::Matrix<long double, 3, 3> rotation = pose.linear().cast<long double>();
  // A body is rigid: without this a rotation matrix's rounding would stretch it, which shows near the
  // smallest R.
  for (int i = 0; i < 4; ++i) rotation = (rotation * 3 - rotation * rotation.transpose() * rotation) / 2;
  const Vector3L translation = pose.translation().cast<long double>();
  for (const Eigen::Vector3d& p : points)
    body.points.push_back(rotation * p.cast<long double>() + translation);
  return body;
}

long double referenceSupport(const ReferenceBody& body, const Vector3L& n, Vector3L* corePoint) {
  // The library rounds R - r once and takes that for rho; near the smallest R this rounding shows.
  const long double rho = static_cast<double>(body.R - body.r);
  long double tolerance = 16 * std::numeric_limits<long double>::epsilon() * (rho + 1);
  const Vector3L* highest = &body.points[0];
  for (const Vector3L& p : body.points)
    if (n.dot(p) > n.dot(*highest)) highest = &p;
  std::vector<Vector3L> basis{*highest};
  Vector3L centre = *highest - rho * n;
  for (int i = 0;; ++i) {
    const Vector3L* worst = nullptr;
    long double miss = tolerance;
    for (const Vector3L& p : body.points) {
      const long double m = (p - centre).norm() - rho;
      if (m > miss) {
        miss = m;
        worst = &p;
      }
    }
    if (!worst) break;
    if (i > 1000) throw std::runtime_error("the reference support does not converge");
    // Many points on nearly the same ball, seen from the one centre there is room for: near the smallest R
    // the centre is only good to the square root of that room.
    if (i % 50 == 49) tolerance *= 8;
    basis.push_back(*worst);
    centre = solveSmall(basis, n, rho, tolerance);
  }
  if (corePoint) *corePoint = centre + rho * n;
  return body.r + rho + n.dot(centre);
}

long double referenceGap(const ReferenceBody& a, const ReferenceBody& b, const Vector3L& n) {
  return -referenceSupport(a, n) - referenceSupport(b, -n);
}

ReferenceDistance referenceDistance(const ReferenceBody& a, const ReferenceBody& b, const Vector3L& towards) {
  const Vector3L z = towards.normalized();
  // The normals with a wider gap than a trial's are a convex set on one side of the plane across its
  // gradient.
  NormalPolygon left(z, 1e3L);
  ReferenceDistance best{-std::numeric_limits<long double>::infinity(), 0, z, {}};
  long double flattest = std::numeric_limits<long double>::infinity();
  for (int i = 0; i < 400; ++i) {
    const Vector3L n = left.centre().normalized();
    Vector3L ya, yb;
    const long double sA = referenceSupport(a, n, &ya), sB = referenceSupport(b, -n, &yb);
    const long double core = -sA - sB + a.r + b.r;
    const Vector3L d = yb - ya;
    const Vector3L across = d - d.dot(n) * n;
    if (core > 0 && across.norm() < flattest) {
      flattest = across.norm();
      best = {-sA - sB, std::hypot(core, across.norm()) - core, n, {ya + a.r * n, yb - b.r * n}};
    }
    if (!left.cut(core > 0 ? across : d)) break;
  }
  return best;
}

long double widestGapOverDirections(const ReferenceBody& a, const ReferenceBody& b, int count) {
  long double best = -std::numeric_limits<long double>::infinity();
  const long double golden = std::acos(-1.0L) * (3 - std::sqrt(5.0L));
  for (int i = 0; i < count; ++i) {  // Fibonacci spiral
    const long double z = 1 - (2 * i + 1) / static_cast<long double>(count), w = std::sqrt(1 - z * z);
    const Vector3L n(w * std::cos(golden * i), w * std::sin(golden * i), z);
    best = std::max(best, referenceGap(a, b, n));
  }
  return best;
}

}  // namespace fcl_stpbv::test
