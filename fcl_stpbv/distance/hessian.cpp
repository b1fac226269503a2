// Second derivatives of the distance (docs/theory.md, 6).
//
// 1. Find the features that face each other at the answer.
// 2. The normal moves with body 2 and turns relative to it so that the gap is maximal. Flat features fix it;
//    edges let it turn in one direction (turning.h).
// 3. The distance is a maximum over these turns, so its second derivative is s_qq - s_qn s_nn^-1 s_nq.
// 4. Normal and witness points follow from the turn.
#include "fcl_stpbv/distance/hessian.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <type_traits>

#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/cross_matrix.h"
#include "fcl_stpbv/distance/patch_pair.h"
#include "fcl_stpbv/distance/turning.h"

namespace fcl_stpbv {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

using namespace detail;

/// Two bodies at an answer. The normal moves with body 2 and turns relative to it by `tau`, which maximises s
/// over the possible turns:
///
///     n = exp(w_B) (n0 + tau),   s = n.(o_B - o_A) - h_B(body 2's normal) - h_A(n seen from body 1)
struct Touch {
  Turning meeting;
  Eigen::Vector3d armA, fromB;  // body 1's witness point relative to both origins
};

double placeRounding(double size) { return 32.0 * std::numeric_limits<double>::epsilon() * size; }

// Overloads for both kinds of bodies.
double sizeOf(const StpBv& body) { return body.centre().norm() + body.enclosingRadius(); }
double sizeOf(const Shape& shape) { return shape.centre.norm() + shape.reach; }
double marginOf(const StpBv&) { return 0.0; }
double marginOf(const Shape& shape) { return shape.margin; }
double pointRounding(const StpBv&, const Vector3d&) { return 0.0; }
/// How far the rounding of a witness point `x` (world) may put a radius of curvature off (m). That of a
/// cone's side depends on the point.
double pointRounding(const Shape& shape, const Vector3d& x) {
  return shape.kind == ShapeKind::cone ? std::numeric_limits<double>::epsilon() * x.lpNorm<1>() : 0.0;
}

/// Body 1 or 2 at an answer: its outward normal, its witness point and its patch.
struct Side {
  Vector3d normal, point;
  int patch;
};

/// The rotation of a pose. It is corrected, as it was for the answer, if it is off by more than the rounding
/// with which features are distinguished. False if it is no rotation.
bool rotationOf(const Isometry3d& pose, Matrix3d& rotation) {
  constexpr double kMost = 1e-14;
  rotation = pose.linear();
  const auto x = rotation.col(0), y = rotation.col(1), z = rotation.col(2);
  if (std::abs(x.dot(x) - 1.0) <= kMost && std::abs(y.dot(y) - 1.0) <= kMost &&
      std::abs(z.dot(z) - 1.0) <= kMost && std::abs(x.dot(y)) <= kMost && std::abs(y.dot(z)) <= kMost &&
      std::abs(z.dot(x)) <= kMost)
    return true;
  Isometry3d rigid = pose;
  if (!makeRigid(rigid)) return false;
  rotation = rigid.linear();
  return true;
}

/// The feature at the witness point, in world axes. `placed` is the rounding error of coordinates relative to
/// the other body (m), `angle` that of the normal (rad).
bool featureOf(const StpBv& body, const Isometry3d& pose, const Side& at, double, double,
               NormalCone& feature) {
  if (at.patch < 0 || at.patch >= body.patchCount()) return false;
  const Radii& radii = body.radii();
  const PatchKind kind = body.kind(at.patch);
  const Vector3d& n = at.normal;
  if (kind != PatchKind::edge) {
    const double radius = kind == PatchKind::face ? radii.R : radii.r;
    const Vector3d e = n.unitOrthogonal();
    feature = {2, n, {e, n.cross(e)}, {radius, radius}, 0.0};
    return true;
  }
  Matrix3d rotation;
  if (!rotationOf(pose, rotation)) return false;
  PosedPatch posed = posedPatch(body, at.patch);
  const Vector3d axis = rotation * unpack(posed.axis);
  posed.axis = pack(axis);
  const EdgeView e = viewEdge(posed, pack(n));
  const Vector3d around = axis.cross(n) / e.c;
  feature = {2, n, {around, n.cross(around)}, {radii.r + e.around, radii.R}, 0.0};
  return true;
}

bool featureOf(const Shape& shape, const Isometry3d& pose, const Side& at, double placed, double angle,
               NormalCone& feature) {
  Matrix3d q;
  if (!rotationOf(pose, q)) return false;
  const double rounding = 1e-13 * shape.reach + placed + 2.0 * shape.reach * angle;
  if (!normalCone(shape, q.transpose() * at.normal, q.transpose() * (at.point - pose.translation()), rounding,
                  feature))
    return false;
  feature.normal = at.normal;
  for (Vector3d& way : feature.way) way = q * way;
  return true;
}

/// The touch of two bodies, each an STP-BV or a shape, at the answer `d`. Rotations are corrected as in the
/// query. False if second derivatives do not exist.
template <typename A, typename B>
bool touchOf(const A& a, const Isometry3d& poseA, const B& b, const Isometry3d& poseB, const Distance& d,
             Touch& touch) {
  constexpr bool kVolumes = std::is_same_v<A, StpBv> && std::is_same_v<B, StpBv>,
                 kShapes = std::is_same_v<A, Shape> && std::is_same_v<B, Shape>;
  if (d.status != DistanceStatus::exact && !(kVolumes && d.status == DistanceStatus::local)) return false;
  if (d.normal.isZero(0)) return false;
  const double placed =
      placeRounding((poseB.translation() - poseA.translation()).norm() + sizeOf(a) + sizeOf(b));
  const double margins = marginOf(a) + marginOf(b);
  double angle = 0.0;
  if (kShapes) {  // the error of the normal of cores that almost touch is rounding divided by their distance
    constexpr double kMost = 1e-3;  // rad
    const double core = std::abs(d.distance + margins);
    angle = placed < kMost * core ? placed / core : kMost;
  }
  NormalCone first, second;
  if (!featureOf(a, poseA, {d.normal, d.point[0], d.patch[0]}, placed, angle, first) ||
      !featureOf(b, poseB, {-d.normal, d.point[1], d.patch[1]}, placed, angle, second))
    return false;
  touch.armA = d.point[0] - poseA.translation();
  touch.fromB = d.point[0] - poseB.translation();
  constexpr double kTold = 4.0;  // times rounding: a smaller sum of radii of curvature counts as zero
  const double rounding =
      placed + placeRounding(margins) + pointRounding(a, d.point[0]) + pointRounding(b, d.point[1]);
  return touch.meeting.set(first, second, d.distance, kTold * rounding);
}

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
