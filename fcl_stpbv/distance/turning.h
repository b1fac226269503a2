// How the normal between two bodies turns where their features meet: what Newton's method on it and second
// derivatives of the distance share (docs/theory.md, 6).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "fcl_stpbv/convex/shape_curvature.h"

namespace fcl_stpbv::detail {

/// A surface's radii of curvature at a normal, the second derivative of its support function: `least` in all
/// directions across the normal, and what is added along `v` and `w`.
struct Curvature {
  Eigen::Vector3d normal;
  double least;
  Eigen::Vector3d v = Eigen::Vector3d::Zero(), w = Eigen::Vector3d::Zero();
  double addedV = 0, addedW = 0;

  Eigen::Vector3d operator*(const Eigen::Vector3d& x) const {
    return least * (x - normal.dot(x) * normal) + (addedV * v.dot(x)) * v + (addedW * w.dot(x)) * w;
  }
  Eigen::Matrix3d matrix() const {
    return least * (Eigen::Matrix3d::Identity() - normal * normal.transpose()) + addedV * v * v.transpose() +
           addedW * w * w.transpose();
  }
};

/// That of a feature along the ways that it leaves open; zero along the others.
inline Curvature curvatureOf(const NormalCone& cone) {
  if (cone.count == 0) return {cone.normal, 0.0};
  const Eigen::Vector3d &v = cone.way[0], &w = cone.way[1];
  if (cone.count == 1) return {cone.normal, 0.0, v, Eigen::Vector3d::Zero(), cone.along[0], 0.0};
  const double share = cone.along[0] > 0.0 ? cone.between / cone.along[0] : 0.0;
  return {cone.normal, 0.0, v + share * w, w, cone.along[0], cone.along[1] - share * cone.between};
}

/// Inverse of -s_nn = W_A + W_B + delta (docs/theory.md, 6) on the ways that body 2 leaves open, zero on the
/// others: there W_B is infinite.
struct Turning {
  Eigen::Vector3d way1 = Eigen::Vector3d::Zero(), way2 = Eigen::Vector3d::Zero();
  double i11 = 0, i12 = 0, i22 = 0;

  Eigen::Vector3d operator*(const Eigen::Vector3d& x) const {
    const double x1 = way1.dot(x), x2 = way2.dot(x);
    return (i11 * x1 + i12 * x2) * way1 + (i12 * x1 + i22 * x2) * way2;
  }
  Eigen::Matrix3d matrix() const {
    return i11 * way1 * way1.transpose() + i22 * way2 * way2.transpose() +
           i12 * (way1 * way2.transpose() + way2 * way1.transpose());
  }
};

/// False unless positive definite, as at a maximum of s, beyond the rounding of the distance (m).
inline bool invert(const Curvature& a, double distance, double rounding, const NormalCone& b,
                   Turning& inverse) {
  inverse = {};
  if (b.count == 0) return true;
  const Eigen::Vector3d &t1 = b.way[0], &t2 = b.way[1];
  const Eigen::Vector3d w1 = a * t1;
  const double m11 = t1.dot(w1) + b.along[0] + distance;
  if (!(m11 > rounding)) return false;
  inverse.way1 = t1;
  inverse.i11 = 1.0 / m11;
  if (b.count == 1) return true;
  const double m22 = t2.dot(a * t2) + b.along[1] + distance, m12 = t2.dot(w1) + b.between;
  const double det = m11 * m22 - m12 * m12;
  if (!(det > 1e-14 * m11 * m22) || !(det > rounding * (m11 + m22))) return false;
  inverse = {t1, t2, m22 / det, -m12 / det, m11 / det};
  return true;
}

}  // namespace fcl_stpbv::detail
