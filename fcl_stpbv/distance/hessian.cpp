// Second derivatives of the distance (docs/theory.md, 6).
//
// 1. The normal is carried by body 2 and turns in it by what maximises the gap; flat features keep it, edges
// let it turn
//    one way.
// 2. The distance is a maximum over these turns, so its second derivative is s_qq - s_qn s_nn^-1 s_nq.
// 3. Normal and witness points follow from the turn.
#include "fcl_stpbv/distance/hessian.h"

#include <cmath>
#include <limits>
#include <utility>

#include "fcl_stpbv/convex/shape_curvature.h"
#include "fcl_stpbv/distance/patch_pair.h"

namespace fcl_stpbv {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

using namespace detail;

Matrix3d cross(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// Second derivative of the body's support function at its outward normal `n`, world axes: the radii of
/// curvature of the surface, zero along `n`.
Matrix3d surfaceCurvature(const StpBv& body, const Isometry3d& pose, int patch, const Vector3d& n) {
  PosedPatch posed = posedPatch(body, patch);
  posed.axis = pack(pose.linear() * unpack(posed.axis));
  return coreCurvature(posed, n) + body.radii().r * (Matrix3d::Identity() - n * n.transpose());
}

/// `t` with `w^T t w = a.(w x (w x n))`: the bend of a rotating body's normal.
Matrix3d bend(const Vector3d& a, const Vector3d& n) {
  return 0.5 * (a * n.transpose() + n * a.transpose()) - a.dot(n) * Matrix3d::Identity();
}

bool owns(const StpBv& body, int patch) { return patch >= 0 && patch < body.patchCount(); }

/// Inverse of -s_nn = W_A + W_B + delta (docs/theory.md, 6) on the ways in world axes that body 2 leaves
/// open, zero on the others: there W_B is infinite. False unless positive definite, as at a maximum of s.
bool invert(const Matrix3d& curvatureA, double distance, const NormalCone& b, Matrix3d& inverse) {
  inverse.setZero();
  if (b.count == 0) return true;
  const Vector3d &t1 = b.way[0], &t2 = b.way[1];
  const double m11 = t1.dot(curvatureA * t1) + b.along[0] + distance;
  if (b.count == 1) {
    if (!(m11 > 0.0)) return false;
    inverse = t1 * t1.transpose() / m11;
    return true;
  }
  const double m22 = t2.dot(curvatureA * t2) + b.along[1] + distance,
               m12 = t1.dot(curvatureA * t2) + b.between;
  const double det = m11 * m22 - m12 * m12;
  if (!(det > 1e-14 * m11 * m22) || !(m11 > 0.0)) return false;
  inverse = (m22 * t1 * t1.transpose() + m11 * t2 * t2.transpose() -
             m12 * (t1 * t2.transpose() + t2 * t1.transpose())) /
            det;
  return true;
}

/// The normal is carried by body 2 and turns in it by `tau`, the maximum of s over the ways it may:
///
///     n = exp(w_B) (n0 + tau),   s = n.(o_B - o_A) - h_B(body 2's normal) - h_A(n seen from body 1)
///
/// so only body 1's radii of curvature, always finite, meet the twists, and body 2's only `tau`.
bool secondOrder(const Matrix3d& curvatureA, const NormalCone& b, const Isometry3d& poseA,
                 const Isometry3d& poseB, const Distance& d, DistanceHessian& result) {
  Matrix3d inverse;
  if (!invert(curvatureA, d.distance, b, inverse)) return false;
  const Vector3d& n = d.normal;
  const Vector3d armA = d.point[0] - poseA.translation(), fromB = d.point[0] - poseB.translation();
  const Matrix3d spin = -cross(n);  // w x n = spin w

  // What the twists do to the normal in body 1 while `tau` is zero, and to the gap's gradient.
  Eigen::Matrix<double, 3, 12> carried, mixed;
  carried << Matrix3d::Zero(), -spin, Matrix3d::Zero(), spin;
  mixed << -Matrix3d::Identity(), cross(armA), Matrix3d::Identity(), -cross(fromB);
  mixed -= curvatureA * carried;
  const Eigen::Matrix<double, 3, 12> turn = inverse * mixed;

  // s_qq: of n.(o_B - o_A), whose normal turns with body 2, and of -h_A, whose normal turns against body 1.
  Eigen::Matrix<double, 12, 12> h = mixed.transpose() * turn - carried.transpose() * curvatureA * carried;
  const auto add = [&](int row, int column, const Matrix3d& m) {
    h.block<3, 3>(row, column) += m;
    h.block<3, 3>(column, row) += m.transpose();
  };
  add(9, 6, cross(n));  // (w_B x n).(v_B - v_A)
  add(9, 0, -cross(n));
  add(3, 9, n * armA.transpose() - armA.dot(n) * Matrix3d::Identity());  // armA.(w_A x (w_B x n))
  h.block<3, 3>(3, 3) -= bend(armA, n);
  h.block<3, 3>(9, 9) -= bend(fromB, n);
  result.matrix = 0.5 * (h + h.transpose());

  result.normal = turn;
  result.normal.block<3, 3>(0, 9) += spin;

  // Body 1's point moves with it and slides by its radii of curvature times the turn of the normal against
  // it; body 2's is the distance away along the normal.
  const Eigen::Matrix<double, 3, 12> against = turn + carried;
  result.point[0] = curvatureA * against;
  result.point[0].block<3, 3>(0, 0) += Matrix3d::Identity();
  result.point[0].block<3, 3>(0, 3) -= cross(armA);
  Eigen::Matrix<double, 1, 12> gradient;
  gradient << d.gradient(0, poseA.translation()).transpose(), d.gradient(1, poseB.translation()).transpose();
  result.point[1] = result.point[0] + n * gradient + d.distance * result.normal;
  return true;
}

/// An answer and its derivatives with the bodies' names exchanged.
Distance exchanged(Distance d) {
  d.normal = -d.normal;
  std::swap(d.point[0], d.point[1]);
  std::swap(d.patch[0], d.patch[1]);
  return d;
}
void exchange(DistanceHessian& h) {
  Eigen::Matrix<double, 12, 12> matrix;
  matrix << h.matrix.bottomRightCorner<6, 6>(), h.matrix.bottomLeftCorner<6, 6>(),
      h.matrix.topRightCorner<6, 6>(), h.matrix.topLeftCorner<6, 6>();
  h.matrix = matrix;
  const auto columns = [](auto& m) {
    const Eigen::Matrix<double, 3, 6> first = m.template leftCols<6>();
    m.template leftCols<6>() = Eigen::Matrix<double, 3, 6>(m.template rightCols<6>());
    m.template rightCols<6>() = first;
  };
  h.normal = -h.normal;
  columns(h.normal);
  std::swap(h.point[0], h.point[1]);
  columns(h.point[0]);
  columns(h.point[1]);
}

}  // namespace

bool hessian(const StpBv& a, const Isometry3d& poseA, const StpBv& b, const Isometry3d& poseB,
             const Distance& d, DistanceHessian& result) {
  if (d.status != DistanceStatus::exact && d.status != DistanceStatus::local) return false;
  if (!owns(a, d.patch[0]) || !owns(b, d.patch[1])) return false;
  const Vector3d& n = d.normal;
  const Vector3d t1 = n.unitOrthogonal(), t2 = n.cross(t1);
  const Matrix3d w = surfaceCurvature(b, poseB, d.patch[1], -n);
  const NormalCone every{2, {t1, t2}, {t1.dot(w * t1), t2.dot(w * t2)}, t1.dot(w * t2)};
  return secondOrder(surfaceCurvature(a, poseA, d.patch[0], n), every, poseA, poseB, d, result);
}

bool hessian(const StpBv& volume, const Isometry3d& poseVolume, const Shape& shape,
             const Isometry3d& poseShape, const Distance& d, DistanceHessian& result) {
  if (d.status != DistanceStatus::exact || !owns(volume, d.patch[0])) return false;
  const Matrix3d& q = poseShape.linear();
  // A face's or an edge's normal is good to the rounding of its corners placed beside the volume.
  const double rounding =
      1e-13 * shape.reach +
      32.0 * std::numeric_limits<double>::epsilon() *
          ((poseShape.translation() - poseVolume.translation()).norm() + volume.centre().norm() +
           volume.enclosingRadius() + shape.centre.norm() + shape.reach);
  NormalCone freedom;
  if (!normalCone(shape, -(q.transpose() * d.normal), q.transpose() * (d.point[1] - poseShape.translation()),
                  rounding, freedom))
    return false;
  for (Vector3d& way : freedom.way) way = q * way;
  return secondOrder(surfaceCurvature(volume, poseVolume, d.patch[0], d.normal), freedom, poseVolume,
                     poseShape, d, result);
}

bool hessian(const Shape& shape, const Isometry3d& poseShape, const StpBv& volume,
             const Isometry3d& poseVolume, const Distance& d, DistanceHessian& result) {
  if (!hessian(volume, poseVolume, shape, poseShape, exchanged(d), result)) return false;
  exchange(result);
  return true;
}

}  // namespace fcl_stpbv
