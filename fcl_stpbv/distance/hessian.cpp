#include "fcl_stpbv/distance/hessian.h"

#include <cmath>

#include "fcl_stpbv/distance/patch_pair.h"

namespace fcl_stpbv {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

Matrix3d cross(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// Second derivative of the body's support function at its outward normal `n`, world axes: the radii of
/// curvature of the surface, zero along `n`.
Matrix3d surfaceCurvature(const StpBv& body, const Isometry3d& pose, int patch, const Vector3d& n) {
  const Patch& p = body.patch(patch);
  const PosedPatch posed{{p.anchor, pose.linear() * p.axis, p.kappa, p.sag}, body.kind(patch), body.radii()};
  return coreCurvature(posed, n) + body.radii().r * (Matrix3d::Identity() - n * n.transpose());
}

/// `t` with `w^T t w = a.(w x (w x n))`: the bend of a rotating body's normal.
Matrix3d bend(const Vector3d& a, const Vector3d& n) {
  return 0.5 * (a * n.transpose() + n * a.transpose()) - a.dot(n) * Matrix3d::Identity();
}

bool owns(const StpBv& body, int patch) { return patch >= 0 && patch < body.patchCount(); }

}  // namespace

bool hessian(const StpBv& a, const Isometry3d& poseA, const StpBv& b, const Isometry3d& poseB,
             const Distance& d, DistanceHessian& result) {
  if (d.status != DistanceStatus::exact && d.status != DistanceStatus::local) return false;
  if (!owns(a, d.patch[0]) || !owns(b, d.patch[1])) return false;
  const Vector3d& n = d.normal;
  const Vector3d armA = d.point[0] - poseA.translation(), armB = d.point[1] - poseB.translation();
  const Matrix3d curvatureA = surfaceCurvature(a, poseA, d.patch[0], n);
  const Matrix3d curvatureB = surfaceCurvature(b, poseB, d.patch[1], -n);

  // -s_nn on the tangent plane; positive definite at a maximum of s.
  const Vector3d t1 = n.unitOrthogonal(), t2 = n.cross(t1);
  const Matrix3d sum = curvatureA + curvatureB;
  const double m11 = t1.dot(sum * t1) + d.distance, m22 = t2.dot(sum * t2) + d.distance,
               m12 = t1.dot(sum * t2);
  const double det = m11 * m22 - m12 * m12;
  if (!(det > 1e-14 * (m11 * m11 + m22 * m22)) || !(m11 > 0.0)) return false;
  const Matrix3d inverse = (m22 * t1 * t1.transpose() + m11 * t2 * t2.transpose() -
                            m12 * (t1 * t2.transpose() + t2 * t1.transpose())) /
                           det;

  // s_nq: a twist moves the core points apart, and turns the bodies under the normal, w x n = spin w.
  const Matrix3d spin = -cross(n);
  Eigen::Matrix<double, 3, 12> mixed;
  mixed << -Matrix3d::Identity(), curvatureA * spin + cross(armA), Matrix3d::Identity(),
      curvatureB * spin - cross(armB);
  const Eigen::Matrix<double, 3, 12> turn = inverse * mixed;

  Eigen::Matrix<double, 12, 12> h = mixed.transpose() * turn;
  h.block<3, 3>(3, 3) -= spin.transpose() * curvatureA * spin + bend(armA, n);
  h.block<3, 3>(9, 9) -= spin.transpose() * curvatureB * spin - bend(armB, n);
  result.matrix = 0.5 * (h + h.transpose());
  result.normal = turn;

  // A body's point moves with it and slides by its radii of curvature times the turn of the normal against
  // it.
  Eigen::Matrix<double, 3, 12> slideA = turn, slideB = turn;
  slideA.block<3, 3>(0, 3) -= spin;
  slideB.block<3, 3>(0, 9) -= spin;
  result.point[0] = curvatureA * slideA;
  result.point[0].block<3, 3>(0, 0) += Matrix3d::Identity();
  result.point[0].block<3, 3>(0, 3) -= cross(armA);
  result.point[1] = -curvatureB * slideB;
  result.point[1].block<3, 3>(0, 6) += Matrix3d::Identity();
  result.point[1].block<3, 3>(0, 9) -= cross(armB);
  return true;
}

}  // namespace fcl_stpbv
