// Second derivatives of the distance (docs/theory.md, 6).
//
// 1. The normal moves with body 2 and turns relative to it so that the gap is maximal. Flat features fix it;
//    edges let it turn in one direction (turning.h).
// 2. The distance is a maximum over these turns, so its second derivative is s_qq - s_qn s_nn^-1 s_nq.
// 3. Normal and witness points follow from the turn.
#include "fcl_stpbv/distance/hessian.h"

#include "fcl_stpbv/cross_matrix.h"
#include "fcl_stpbv/distance/touch.h"

namespace fcl_stpbv {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

using namespace detail;

/// The matrix `t` with `w^T t w = a.(w x (w x n))`: second-order change of a rotating body's normal, times
/// `a`.
Matrix3d secondTurn(const Vector3d& a, const Vector3d& n) {
  return 0.5 * (a * n.transpose() + n * a.transpose()) - a.dot(n) * Matrix3d::Identity();
}

void secondOrder(const Touch& touch, const Isometry3d& poseA, const Isometry3d& poseB, const Distance& d,
                 DistanceHessian& result) {
  const Turning& meeting = touch.meeting;
  const Vector3d &n = d.normal, &armA = touch.armA, &fromB = touch.fromB;
  const Matrix3d spin = -crossMatrix(n);  // w x n = spin w

  // How the twists move both points relative to each other, and turn the normal in body 1; across the normal.
  const Eigen::Matrix<double, 2, 3> across = meeting.frame.transpose();
  const Eigen::Matrix<double, 2, 3> rotated = across * spin;
  Eigen::Matrix<double, 2, 12> apart, carried;
  apart << -across, across * crossMatrix(armA), across, -across * crossMatrix(fromB);
  carried << Eigen::Matrix<double, 2, 3>::Zero(), -rotated, Eigen::Matrix<double, 2, 3>::Zero(), rotated;
  const Eigen::Matrix<double, 2, 12> turn = meeting.turning * apart - meeting.sliding.transpose() * carried,
                                     slide = meeting.sliding * apart + meeting.rolling * carried;

  // s_qq has terms of n.(o_B - o_A), whose normal turns with body 2, and of -h_A, whose normal turns against
  // body 1.
  // lazyProduct(), because Eigen would call its product of large matrices for sums of two terms.
  Eigen::Matrix<double, 12, 12> h =
      apart.transpose().lazyProduct(turn) - carried.transpose().lazyProduct(slide);
  const auto add = [&](int row, int column, const Matrix3d& m) {
    h.block<3, 3>(row, column) += m;
    h.block<3, 3>(column, row) += m.transpose();
  };
  add(9, 6, crossMatrix(n));  // (w_B x n).(v_B - v_A)
  add(9, 0, -crossMatrix(n));
  add(3, 9, n * armA.transpose() - armA.dot(n) * Matrix3d::Identity());  // armA.(w_A x (w_B x n))
  h.block<3, 3>(3, 3) -= secondTurn(armA, n);
  h.block<3, 3>(9, 9) -= secondTurn(fromB, n);
  result.matrix = 0.5 * (h + h.transpose());

  result.normal = meeting.frame * turn;
  result.normal.block<3, 3>(0, 9) += spin;

  // Body 1's point moves with body 1 and slides on it. Body 2's point is the distance away along the normal.
  result.point[0] = meeting.frame * slide;
  result.point[0].block<3, 3>(0, 0) += Matrix3d::Identity();
  result.point[0].block<3, 3>(0, 3) -= crossMatrix(armA);
  Eigen::Matrix<double, 1, 12> gradient;
  gradient << d.gradient(0, poseA.translation()).transpose(), d.gradient(1, poseB.translation()).transpose();
  result.point[1] = result.point[0] + n * gradient + d.distance * result.normal;
}

/// The first-order changes along one motion of both bodies.
void firstOrder(const Touch& touch, const Distance& d, const BodyTwists& twists, DistanceRate& result) {
  const Turning& meeting = touch.meeting;
  const Vector3d wA = twists.segment<3>(3), wB = twists.segment<3>(9);
  const Vector3d fixedA = twists.head<3>() + wA.cross(touch.armA);
  const Vector3d motion = twists.segment<3>(6) + wB.cross(touch.fromB) - fixedA;
  const Vector2d apart = meeting.frame.transpose() * motion,
                 carried = meeting.frame.transpose() * (wB - wA).cross(d.normal);
  result.normal =
      meeting.frame * (meeting.turning * apart - meeting.sliding.transpose() * carried) + wB.cross(d.normal);
  result.point[0] = fixedA + meeting.frame * (meeting.sliding * apart + meeting.rolling * carried);
  result.point[1] = result.point[0] + d.normal.dot(motion) * d.normal + d.distance * result.normal;
}

template <typename A, typename B>
bool hessianOf(const A& a, const Isometry3d& poseA, const B& b, const Isometry3d& poseB, const Distance& d,
               DistanceHessian& result) {
  Touch touch;
  if (!touchOf(a, poseA, b, poseB, d, touch)) return false;
  secondOrder(touch, poseA, poseB, d, result);
  return true;
}

template <typename A, typename B>
bool rateOf(const A& a, const Isometry3d& poseA, const B& b, const Isometry3d& poseB, const Distance& d,
            const BodyTwists& twists, DistanceRate& result) {
  Touch touch;
  if (!touchOf(a, poseA, b, poseB, d, touch)) return false;
  firstOrder(touch, d, twists, result);
  return true;
}

}  // namespace

bool hessian(const StpBv& a, const Isometry3d& poseA, const StpBv& b, const Isometry3d& poseB,
             const Distance& d, DistanceHessian& result) {
  return hessianOf(a, poseA, b, poseB, d, result);
}

bool hessian(const StpBv& volume, const Isometry3d& poseVolume, const Shape& shape,
             const Isometry3d& poseShape, const Distance& d, DistanceHessian& result) {
  return hessianOf(volume, poseVolume, shape, poseShape, d, result);
}

bool hessian(const Shape& shape, const Isometry3d& poseShape, const StpBv& volume,
             const Isometry3d& poseVolume, const Distance& d, DistanceHessian& result) {
  return hessianOf(shape, poseShape, volume, poseVolume, d, result);
}

bool hessian(const Shape& a, const Isometry3d& poseA, const Shape& b, const Isometry3d& poseB,
             const Distance& d, DistanceHessian& result) {
  return hessianOf(a, poseA, b, poseB, d, result);
}

bool rate(const StpBv& a, const Isometry3d& poseA, const StpBv& b, const Isometry3d& poseB, const Distance& d,
          const BodyTwists& twists, DistanceRate& result) {
  return rateOf(a, poseA, b, poseB, d, twists, result);
}

bool rate(const StpBv& volume, const Isometry3d& poseVolume, const Shape& shape, const Isometry3d& poseShape,
          const Distance& d, const BodyTwists& twists, DistanceRate& result) {
  return rateOf(volume, poseVolume, shape, poseShape, d, twists, result);
}

bool rate(const Shape& shape, const Isometry3d& poseShape, const StpBv& volume, const Isometry3d& poseVolume,
          const Distance& d, const BodyTwists& twists, DistanceRate& result) {
  return rateOf(shape, poseShape, volume, poseVolume, d, twists, result);
}

bool rate(const Shape& a, const Isometry3d& poseA, const Shape& b, const Isometry3d& poseB, const Distance& d,
          const BodyTwists& twists, DistanceRate& result) {
  return rateOf(a, poseA, b, poseB, d, twists, result);
}

}  // namespace fcl_stpbv
