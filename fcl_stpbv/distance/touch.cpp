// Finds the features that face each other at an answer, and how the normal between them can turn.
#include "fcl_stpbv/distance/touch.h"

#include <cmath>
#include <limits>
#include <type_traits>

#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/distance/patch_pair.h"

namespace fcl_stpbv::detail {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

double placeRounding(double size) { return 32.0 * std::numeric_limits<double>::epsilon() * size; }

// Overloads for both kinds of bodies.
double sizeOf(const StpBv& body) { return body.centre().norm() + body.enclosingRadius(); }
double sizeOf(const Shape& shape) { return shape.centre.norm() + shape.reach; }
double marginOf(const StpBv&) { return 0.0; }
double marginOf(const Shape& shape) { return shape.margin; }

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

}  // namespace

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
  return touch.meeting.set(first, second, d.distance, kTold * (placed + placeRounding(margins)));
}

template bool touchOf(const StpBv&, const Isometry3d&, const StpBv&, const Isometry3d&, const Distance&,
                      Touch&);
template bool touchOf(const StpBv&, const Isometry3d&, const Shape&, const Isometry3d&, const Distance&,
                      Touch&);
template bool touchOf(const Shape&, const Isometry3d&, const StpBv&, const Isometry3d&, const Distance&,
                      Touch&);
template bool touchOf(const Shape&, const Isometry3d&, const Shape&, const Isometry3d&, const Distance&,
                      Touch&);

}  // namespace fcl_stpbv::detail
