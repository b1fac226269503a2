// Second derivatives of the distance (docs/theory.md, 6).
//
// 1. The normal is carried by body 2 and turns in it by what maximises the gap; flat features keep it,
//    edges let it turn one way.
// 2. The distance is a maximum over these turns, so its second derivative is s_qq - s_qn s_nn^-1 s_nq.
// 3. Normal and witness points follow from the turn.
#include "fcl_stpbv/distance/hessian.h"

#include <utility>

#include "fcl_stpbv/cross_matrix.h"
#include "fcl_stpbv/distance/touch.h"

namespace fcl_stpbv {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

using namespace detail;

/// `t` with `w^T t w = a.(w x (w x n))`: the bend of a rotating body's normal.
Matrix3d bend(const Vector3d& a, const Vector3d& n) {
  return 0.5 * (a * n.transpose() + n * a.transpose()) - a.dot(n) * Matrix3d::Identity();
}

void secondOrder(const Touch& touch, const Isometry3d& poseA, const Isometry3d& poseB, const Distance& d,
                 DistanceHessian& result) {
  const Matrix3d curvatureA = touch.a.matrix();
  const Vector3d &n = d.normal, &armA = touch.armA, &fromB = touch.fromB;
  const Matrix3d spin = -crossMatrix(n);  // w x n = spin w

  // What the twists do to the normal in body 1 while `tau` is zero, and to the gap's gradient.
  Eigen::Matrix<double, 3, 12> carried, mixed;
  carried << Matrix3d::Zero(), -spin, Matrix3d::Zero(), spin;
  mixed << -Matrix3d::Identity(), crossMatrix(armA), Matrix3d::Identity(), -crossMatrix(fromB);
  mixed -= curvatureA * carried;
  Eigen::Matrix<double, 3, 12> turn = touch.inverse.matrix() * mixed;
  if (touch.crossing) turn = -touch.way * (touch.edge.transpose() * carried);

  // s_qq: of n.(o_B - o_A), whose normal turns with body 2, and of -h_A, whose normal turns against body 1.
  // Term by term: Eigen would call its product of large matrices, for sums of three.
  const Eigen::Matrix<double, 3, 12> bent = curvatureA * carried;
  Eigen::Matrix<double, 12, 12> h =
      mixed.transpose().lazyProduct(turn) - carried.transpose().lazyProduct(bent);
  Eigen::Matrix<double, 1, 12> left = Eigen::Matrix<double, 1, 12>::Zero();
  if (touch.crossing) {
    left = touch.left(mixed, turn);
    h += (turn.transpose() * touch.way).lazyProduct(left);
  }
  const auto add = [&](int row, int column, const Matrix3d& m) {
    h.block<3, 3>(row, column) += m;
    h.block<3, 3>(column, row) += m.transpose();
  };
  add(9, 6, crossMatrix(n));  // (w_B x n).(v_B - v_A)
  add(9, 0, -crossMatrix(n));
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
  result.point[0].block<3, 3>(0, 3) -= crossMatrix(armA);
  if (touch.crossing) result.point[0] += touch.edge * left;
  Eigen::Matrix<double, 1, 12> gradient;
  gradient << d.gradient(0, poseA.translation()).transpose(), d.gradient(1, poseB.translation()).transpose();
  result.point[1] = result.point[0] + n * gradient + d.distance * result.normal;
}

/// The same along one motion of both bodies.
void firstOrder(const Touch& touch, const Distance& d, const BodyTwists& twists, DistanceRate& result) {
  const Vector3d wA = twists.segment<3>(3), wB = twists.segment<3>(9);
  const Vector3d fixedA = twists.head<3>() + wA.cross(touch.armA);
  const Vector3d apart = twists.segment<3>(6) + wB.cross(touch.fromB) - fixedA;
  const Vector3d carried = (wB - wA).cross(d.normal);
  const Vector3d mixed = apart - touch.a * carried;
  const Vector3d turn =
      touch.crossing ? Vector3d(-touch.edge.dot(carried) * touch.way) : touch.inverse * mixed;
  result.normal = turn + wB.cross(d.normal);
  result.point[0] = fixedA + touch.a * (turn + carried);
  if (touch.crossing) result.point[0] += touch.left(mixed, turn).value() * touch.edge;
  result.point[1] = result.point[0] + d.normal.dot(apart) * d.normal + d.distance * result.normal;
}

/// Motions and derivatives with the bodies' names exchanged.
BodyTwists exchanged(const BodyTwists& twists) {
  BodyTwists other;
  other << twists.tail<6>(), twists.head<6>();
  return other;
}
void exchange(DistanceRate& rate) {
  rate.normal = -rate.normal;
  std::swap(rate.point[0], rate.point[1]);
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
  Touch touch;
  if (!touchOf(a, poseA, b, poseB, d, touch)) return false;
  secondOrder(touch, poseA, poseB, d, result);
  return true;
}

bool hessian(const StpBv& volume, const Isometry3d& poseVolume, const Shape& shape,
             const Isometry3d& poseShape, const Distance& d, DistanceHessian& result) {
  Touch touch;
  if (!touchOf(volume, poseVolume, shape, poseShape, d, touch)) return false;
  secondOrder(touch, poseVolume, poseShape, d, result);
  return true;
}

bool hessian(const Shape& shape, const Isometry3d& poseShape, const StpBv& volume,
             const Isometry3d& poseVolume, const Distance& d, DistanceHessian& result) {
  if (!hessian(volume, poseVolume, shape, poseShape, exchanged(d), result)) return false;
  exchange(result);
  return true;
}

bool hessian(const Shape& a, const Isometry3d& poseA, const Shape& b, const Isometry3d& poseB,
             const Distance& d, DistanceHessian& result) {
  Touch touch;
  bool swapped = false;
  if (!touchOf(a, poseA, b, poseB, d, touch, swapped)) return false;
  if (!swapped) {
    secondOrder(touch, poseA, poseB, d, result);
  } else {
    secondOrder(touch, poseB, poseA, exchanged(d), result);
    exchange(result);
  }
  return true;
}

bool rate(const StpBv& a, const Isometry3d& poseA, const StpBv& b, const Isometry3d& poseB, const Distance& d,
          const BodyTwists& twists, DistanceRate& result) {
  Touch touch;
  if (!touchOf(a, poseA, b, poseB, d, touch)) return false;
  firstOrder(touch, d, twists, result);
  return true;
}

bool rate(const StpBv& volume, const Isometry3d& poseVolume, const Shape& shape, const Isometry3d& poseShape,
          const Distance& d, const BodyTwists& twists, DistanceRate& result) {
  Touch touch;
  if (!touchOf(volume, poseVolume, shape, poseShape, d, touch)) return false;
  firstOrder(touch, d, twists, result);
  return true;
}

bool rate(const Shape& shape, const Isometry3d& poseShape, const StpBv& volume, const Isometry3d& poseVolume,
          const Distance& d, const BodyTwists& twists, DistanceRate& result) {
  if (!rate(volume, poseVolume, shape, poseShape, exchanged(d), exchanged(twists), result)) return false;
  exchange(result);
  return true;
}

bool rate(const Shape& a, const Isometry3d& poseA, const Shape& b, const Isometry3d& poseB, const Distance& d,
          const BodyTwists& twists, DistanceRate& result) {
  Touch touch;
  bool swapped = false;
  if (!touchOf(a, poseA, b, poseB, d, touch, swapped)) return false;
  if (!swapped) {
    firstOrder(touch, d, twists, result);
  } else {
    firstOrder(touch, exchanged(d), exchanged(twists), result);
    exchange(result);
  }
  return true;
}

}  // namespace fcl_stpbv
