// Second derivatives of the distance (docs/theory.md, 6).
//
// 1. The normal is carried by body 2 and turns in it by what maximises the gap; flat features keep it,
//    edges let it turn one way.
// 2. The distance is a maximum over these turns, so its second derivative is s_qq - s_qn s_nn^-1 s_nq.
// 3. Normal and witness points follow from the turn.
#include "fcl_stpbv/distance/hessian.h"

#include <cmath>
#include <limits>
#include <utility>

#include "fcl_stpbv/convex/shape_curvature.h"
#include "fcl_stpbv/cross_matrix.h"
#include "fcl_stpbv/distance/patch_pair.h"

namespace fcl_stpbv {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

using namespace detail;

/// A surface's radii of curvature at a normal, the second derivative of its support function: `least` in all
/// directions across the normal, and what an edge's patch adds around its edge and across.
struct Curvature {
  Vector3d normal;
  double least;
  Vector3d v = Vector3d::Zero(), w = Vector3d::Zero();
  double addedV = 0, addedW = 0;

  Vector3d operator*(const Vector3d& x) const {
    return least * (x - normal.dot(x) * normal) + (addedV * v.dot(x)) * v + (addedW * w.dot(x)) * w;
  }
  Matrix3d matrix() const {
    return least * (Matrix3d::Identity() - normal * normal.transpose()) + addedV * v * v.transpose() +
           addedW * w * w.transpose();
  }
};

/// That of the body at its outward normal `n`, world axes.
Curvature surfaceCurvature(const StpBv& body, const Isometry3d& pose, int patch, const Vector3d& n) {
  const Radii& radii = body.radii();
  const PatchKind kind = body.kind(patch);
  if (kind != PatchKind::edge) return {n, kind == PatchKind::face ? radii.R : radii.r};
  PosedPatch posed = posedPatch(body, patch);
  const Vector3d axis = pose.linear() * unpack(posed.axis);
  posed.axis = pack(axis);
  const EdgeView e = viewEdge(posed, pack(n));
  const Vector3d v = axis.cross(n) / e.c;
  return {n, radii.r, v, n.cross(v), e.around, radii.rho};
}

/// `t` with `w^T t w = a.(w x (w x n))`: the bend of a rotating body's normal.
Matrix3d bend(const Vector3d& a, const Vector3d& n) {
  return 0.5 * (a * n.transpose() + n * a.transpose()) - a.dot(n) * Matrix3d::Identity();
}

bool owns(const StpBv& body, int patch) { return patch >= 0 && patch < body.patchCount(); }

/// Inverse of -s_nn = W_A + W_B + delta (docs/theory.md, 6) on the ways in world axes that body 2 leaves
/// open, zero on the others: there W_B is infinite.
struct Turning {
  Vector3d way1 = Vector3d::Zero(), way2 = Vector3d::Zero();
  double i11 = 0, i12 = 0, i22 = 0;

  Vector3d operator*(const Vector3d& x) const {
    const double x1 = way1.dot(x), x2 = way2.dot(x);
    return (i11 * x1 + i12 * x2) * way1 + (i12 * x1 + i22 * x2) * way2;
  }
  Matrix3d matrix() const {
    return i11 * way1 * way1.transpose() + i22 * way2 * way2.transpose() +
           i12 * (way1 * way2.transpose() + way2 * way1.transpose());
  }
};

/// False unless positive definite, as at a maximum of s.
bool invert(const Curvature& a, double distance, const NormalCone& b, Turning& inverse) {
  inverse = {};
  if (b.count == 0) return true;
  const Vector3d &t1 = b.way[0], &t2 = b.way[1];
  const Vector3d w1 = a * t1;
  const double m11 = t1.dot(w1) + b.along[0] + distance;
  if (!(m11 > 0.0)) return false;
  inverse.way1 = t1;
  inverse.i11 = 1.0 / m11;
  if (b.count == 1) return true;
  const double m22 = t2.dot(a * t2) + b.along[1] + distance, m12 = t2.dot(w1) + b.between;
  const double det = m11 * m22 - m12 * m12;
  if (!(det > 1e-14 * m11 * m22)) return false;
  inverse = {t1, t2, m22 / det, -m12 / det, m11 / det};
  return true;
}

/// Two bodies at an answer. The normal is carried by body 2 and turns in it by `tau`, the maximum of s over
/// the ways it may:
///
///     n = exp(w_B) (n0 + tau),   s = n.(o_B - o_A) - h_B(body 2's normal) - h_A(n seen from body 1)
///
/// so only body 1's radii of curvature, always finite, meet the twists, and body 2's only `tau`.
struct Touch {
  Curvature a;
  Turning inverse;
  Vector3d armA, fromB;  // body 1's witness point from both origins

  bool set(const NormalCone& b, const Isometry3d& poseA, const Isometry3d& poseB, const Distance& d) {
    armA = d.point[0] - poseA.translation();
    fromB = d.point[0] - poseB.translation();
    return invert(a, d.distance, b, inverse);
  }
};

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
  const Eigen::Matrix<double, 3, 12> turn = touch.inverse.matrix() * mixed;

  // s_qq: of n.(o_B - o_A), whose normal turns with body 2, and of -h_A, whose normal turns against body 1.
  // Term by term: Eigen would call its product of large matrices, for sums of three.
  const Eigen::Matrix<double, 3, 12> bent = curvatureA * carried;
  Eigen::Matrix<double, 12, 12> h =
      mixed.transpose().lazyProduct(turn) - carried.transpose().lazyProduct(bent);
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
  const Vector3d turn = touch.inverse * (apart - touch.a * carried);
  result.normal = turn + wB.cross(d.normal);
  result.point[0] = fixedA + touch.a * (turn + carried);
  result.point[1] = result.point[0] + d.normal.dot(apart) * d.normal + d.distance * result.normal;
}

/// False where the second derivatives do not exist.
bool touchOf(const StpBv& a, const Isometry3d& poseA, const StpBv& b, const Isometry3d& poseB,
             const Distance& d, Touch& touch) {
  if (d.status != DistanceStatus::exact && d.status != DistanceStatus::local) return false;
  if (!owns(a, d.patch[0]) || !owns(b, d.patch[1])) return false;
  const Vector3d& n = d.normal;
  const Vector3d t1 = n.unitOrthogonal(), t2 = n.cross(t1);
  const Curvature w = surfaceCurvature(b, poseB, d.patch[1], -n);
  const Vector3d w1 = w * t1;
  const NormalCone every{2, {t1, t2}, {t1.dot(w1), t2.dot(w * t2)}, t2.dot(w1)};
  touch.a = surfaceCurvature(a, poseA, d.patch[0], n);
  return touch.set(every, poseA, poseB, d);
}

bool touchOf(const StpBv& volume, const Isometry3d& poseVolume, const Shape& shape,
             const Isometry3d& poseShape, const Distance& d, Touch& touch) {
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
  touch.a = surfaceCurvature(volume, poseVolume, d.patch[0], d.normal);
  return touch.set(freedom, poseVolume, poseShape, d);
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
  BodyTwists other;
  other << twists.tail<6>(), twists.head<6>();
  if (!rate(volume, poseVolume, shape, poseShape, exchanged(d), other, result)) return false;
  result.normal = -result.normal;
  std::swap(result.point[0], result.point[1]);
  return true;
}

}  // namespace fcl_stpbv
