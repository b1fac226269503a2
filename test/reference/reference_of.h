// The reference of reference.h for numbers of any precision: long double, or a hundred digits for a sample.
#pragma once

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "test/reference/normal_polygon.h"
#include "test/reference/reference.h"

namespace fcl_stpbv::test {

/// The lowest centre along `n` whose ball of radius `rho` has these one, two or three points on its surface.
/// False if there is none.
template <class Real>
bool lowestCentre(const std::vector<Vector3Of<Real>>& p, const Vector3Of<Real>& n, Real rho,
                  Vector3Of<Real>& centre) {
  using std::sqrt;
  if (p.size() == 1) {
    centre = p[0] - rho * n;
    return true;
  }
  if (p.size() == 2) {
    const Vector3Of<Real> half = (p[1] - p[0]) / 2;
    const Vector3Of<Real> u = half.normalized();
    const Real kappa2 = (rho - half.norm()) * (rho + half.norm());
    const Vector3Of<Real> across = n - n.dot(u) * u;
    if (kappa2 < 0 || !(across.norm() > 0)) return false;
    centre = p[0] + half - sqrt(kappa2) * across.normalized();
    return true;
  }
  const Vector3Of<Real> e = p[1] - p[0], f = p[2] - p[0], x = e.cross(f);
  const Real x2 = x.squaredNorm();
  if (!(x2 > 0)) return false;
  const Vector3Of<Real> c = (f.squaredNorm() * x.cross(e) + e.squaredNorm() * f.cross(x)) / (2 * x2);
  const Real height2 = (rho - c.norm()) * (rho + c.norm());
  if (height2 < 0) return false;
  const Vector3Of<Real> up = x / sqrt(x2);
  centre = p[0] + c - sqrt(height2) * (n.dot(up) > 0 ? up : Vector3Of<Real>(-up));
  return true;
}

/// The lowest feasible centre for a few points: the best over their subsets of at most three. `basis` becomes
/// the best subset.
template <class Real>
Vector3Of<Real> solveSmall(std::vector<Vector3Of<Real>>& basis, const Vector3Of<Real>& n, Real rho,
                           Real tolerance) {
  const std::vector<Vector3Of<Real>> all = basis;
  Real lowest = std::numeric_limits<Real>::infinity();
  Real leastMiss = std::numeric_limits<Real>::infinity();
  Vector3Of<Real> best = all[0];
  for (unsigned subset = 1; subset < (1u << all.size()); ++subset) {
    std::vector<Vector3Of<Real>> chosen;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (subset >> i & 1u) chosen.push_back(all[i]);
    if (chosen.size() > 3) continue;
    Vector3Of<Real> centre;
    if (!lowestCentre(chosen, n, rho, centre)) continue;
    Real miss = 0;
    for (const Vector3Of<Real>& q : all) miss = std::max(miss, (q - centre).norm() - rho);
    // Feasible centres are compared by height. If rounding leaves none, the centre that misses least is
    // taken.
    const bool feasible = miss <= tolerance;
    const Real height = n.dot(centre);
    if (feasible ? (leastMiss > tolerance || height < lowest) : miss < leastMiss) {
      best = centre;
      basis = chosen;
      lowest = height;
      leastMiss = miss;
    }
  }
  return best;
}

template <class Real>
ReferenceBodyOf<Real> bodyOf(const Cloud& points, double r, double R, const Eigen::Isometry3d& pose) {
  ReferenceBodyOf<Real> body;
  body.r = r;
  body.R = R;
  Eigen::Matrix<Real, 3, 3> rotation = pose.linear().cast<Real>();
  // A body is rigid. Without this, the rounding of a rotation matrix would stretch it, which is noticeable
  // near the smallest R.
  for (int i = 0; i < 4; ++i) rotation = (rotation * 3 - rotation * rotation.transpose() * rotation) / 2;
  const Vector3Of<Real> translation = pose.translation().cast<Real>();
  for (const Eigen::Vector3d& p : points) body.points.push_back(rotation * p.cast<Real>() + translation);
  return body;
}

template <class Real>
Real supportOf(const ReferenceBodyOf<Real>& body, const Vector3Of<Real>& n,
               Vector3Of<Real>* corePoint = nullptr) {
  // The library rounds R - r once and uses that as rho. Near the smallest R this rounding is noticeable.
  const Real rho = static_cast<double>(body.R - body.r);
  Real tolerance = 16 * std::numeric_limits<Real>::epsilon() * (rho + 1);
  const Vector3Of<Real>* highest = &body.points[0];
  for (const Vector3Of<Real>& p : body.points)
    if (n.dot(p) > n.dot(*highest)) highest = &p;
  std::vector<Vector3Of<Real>> basis{*highest};
  Vector3Of<Real> centre = *highest - rho * n;
  for (int i = 0;; ++i) {
    const Vector3Of<Real>* worst = nullptr;
    Real miss = tolerance;
    for (const Vector3Of<Real>& p : body.points) {
      const Real m = (p - centre).norm() - rho;
      if (m > miss) {
        miss = m;
        worst = &p;
      }
    }
    if (!worst) break;
    if (i > 1000) throw std::runtime_error("the reference support does not converge");
    // Near the smallest R there is little room for the centre, and many points are almost on the same ball.
    // There the centre is only accurate to the square root of that room.
    if (i % 50 == 49) tolerance *= 8;
    basis.push_back(*worst);
    centre = solveSmall(basis, n, rho, tolerance);
  }
  if (corePoint) *corePoint = centre + rho * n;
  return body.r + rho + n.dot(centre);
}

/// Like referenceDistance(), but ends if `gap` is at most `enough`, and searches normals up to `reach` to the
/// side of `towards`, which has length 1.
template <class Real>
ReferenceDistanceOf<Real> distanceOf(const ReferenceBodyOf<Real>& a, const ReferenceBodyOf<Real>& b,
                                     const Vector3Of<Real>& towards, const Real& enough = 0,
                                     double reach = 1e3) {
  using std::sqrt;
  const Vector3Of<Real> z = towards.normalized();
  // The normals with a wider gap than a trial's are a convex set on one side of the plane across its
  // gradient.
  NormalPolygonOf<Real> left(z, reach);
  ReferenceDistanceOf<Real> best{-std::numeric_limits<Real>::infinity(), 0, z, {}};
  Real flattest = std::numeric_limits<Real>::infinity();
  for (int i = 0; i < 6 * std::numeric_limits<Real>::digits + 16; ++i) {
    const Vector3Of<Real> n = left.centre().normalized();
    Vector3Of<Real> ya, yb;
    const Real sA = supportOf(a, n, &ya), sB = supportOf<Real>(b, -n, &yb);
    const Real core = -sA - sB + a.r + b.r;
    const Vector3Of<Real> d = yb - ya;
    const Vector3Of<Real> across = d - d.dot(n) * n;
    if (core > 0 && across.norm() < flattest) {
      flattest = across.norm();
      const Real w2 = across.squaredNorm();
      best = {-sA - sB, w2 / (sqrt(core * core + w2) + core), n, {ya + a.r * n, yb - b.r * n}};
    }
    if (core > 0 && best.gap <= enough) break;
    if (!left.cut(core > 0 ? across : d)) break;
  }
  return best;
}

}  // namespace fcl_stpbv::test
