// Which features face each other at an answer, and how the normal between them may turn.
#include "fcl_stpbv/distance/touch.h"

#include <cmath>
#include <limits>
#include <utility>

#include "fcl_stpbv/distance/patch_pair.h"

namespace fcl_stpbv::detail {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// An STP-BV's radii of curvature at its outward normal `n`, world axes.
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

bool owns(const StpBv& body, int patch) { return patch >= 0 && patch < body.patchCount(); }

/// The feature that faces the other body along the world's outward normal `m` at the point `x` of the shape,
/// world axes; `placed` is the rounding of coordinates beside the other body, `angle` that of the normal.
bool featureOf(const Shape& shape, const Isometry3d& pose, const Vector3d& m, const Vector3d& x,
               double placed, double angle, NormalCone& feature) {
  const Matrix3d& q = pose.linear();
  const double rounding = 1e-13 * shape.reach + placed + 2.0 * shape.reach * angle;
  if (!normalCone(shape, q.transpose() * m, q.transpose() * (x - pose.translation()), rounding, feature))
    return false;
  for (Vector3d& way : feature.way) way = q * way;
  return true;
}

/// The touch of two features, the second no more curved than the first.
bool touchOfFeatures(const NormalCone& first, const Isometry3d& poseFirst, const NormalCone& second,
                     const Isometry3d& poseSecond, const Distance& d, double rounding, Touch& touch) {
  if (first.count == 1 && second.count == 1) return touch.cross(first, second, poseFirst, poseSecond, d);
  touch.a = curvatureOf(first);
  return first.count == 2 && touch.set(second, poseFirst, poseSecond, d, rounding);
}

double placeRounding(double size) { return 32.0 * std::numeric_limits<double>::epsilon() * size; }

}  // namespace

bool Touch::set(const NormalCone& b, const Isometry3d& poseA, const Isometry3d& poseB, const Distance& d,
                double rounding) {
  constexpr double kTold = 4.0;  // radii of curvature that sum up to less of the rounding are none
  armA = d.point[0] - poseA.translation();
  fromB = d.point[0] - poseB.translation();
  return invert(a, d.distance, kTold * rounding, b, inverse);
}

bool Touch::cross(const NormalCone& first, const NormalCone& second, const Isometry3d& poseA,
                  const Isometry3d& poseB, const Distance& d) {
  constexpr double kParallel = 1e-7;
  armA = d.point[0] - poseA.translation();
  fromB = d.point[0] - poseB.translation();
  a = curvatureOf(first);
  way = second.way[0];
  edge = d.normal.cross(first.way[0]);
  const double sine = edge.dot(way);
  edge /= sine;
  stiffness = second.along[0] + d.distance;
  crossing = true;
  return std::abs(sine) > kParallel;
}

bool touchOf(const StpBv& a, const Isometry3d& poseA, const StpBv& b, const Isometry3d& poseB,
             const Distance& d, Touch& touch) {
  if (d.status != DistanceStatus::exact && d.status != DistanceStatus::local) return false;
  if (!owns(a, d.patch[0]) || !owns(b, d.patch[1])) return false;
  const Vector3d& n = d.normal;
  const Vector3d t1 = n.unitOrthogonal(), t2 = n.cross(t1);
  const Curvature w = surfaceCurvature(b, poseB, d.patch[1], -n);
  const Vector3d w1 = w * t1;
  const NormalCone every{2, -n, {t1, t2}, {t1.dot(w1), t2.dot(w * t2)}, t2.dot(w1)};
  touch.a = surfaceCurvature(a, poseA, d.patch[0], n);
  const double size = (poseB.translation() - poseA.translation()).norm() + a.centre().norm() +
                      a.enclosingRadius() + b.centre().norm() + b.enclosingRadius();
  return touch.set(every, poseA, poseB, d, placeRounding(size));
}

bool touchOf(const StpBv& volume, const Isometry3d& poseVolume, const Shape& shape,
             const Isometry3d& poseShape, const Distance& d, Touch& touch) {
  if (d.status != DistanceStatus::exact || !owns(volume, d.patch[0])) return false;
  const double size = (poseShape.translation() - poseVolume.translation()).norm() + volume.centre().norm() +
                      volume.enclosingRadius() + shape.centre.norm() + shape.reach;
  const double placed = placeRounding(size);
  NormalCone feature;
  if (!featureOf(shape, poseShape, -d.normal, d.point[1], placed, 0.0, feature)) return false;
  touch.a = surfaceCurvature(volume, poseVolume, d.patch[0], d.normal);
  return touch.set(feature, poseVolume, poseShape, d, placed + placeRounding(shape.margin));
}

bool touchOf(const Shape& a, const Isometry3d& poseA, const Shape& b, const Isometry3d& poseB,
             const Distance& d, Touch& touch, bool& swapped) {
  constexpr double kMost = 1e-3;  // rad
  if (d.status != DistanceStatus::exact || d.normal.isZero(0)) return false;
  const double placed = placeRounding((poseB.translation() - poseA.translation()).norm() + a.centre.norm() +
                                      a.reach + b.centre.norm() + b.reach);
  // The normal of cores that all but touch is known to rounding over their distance.
  const double core = std::abs(d.distance + a.margin + b.margin);
  const double angle = placed < kMost * core ? placed / core : kMost;
  NormalCone first, second;
  if (!featureOf(a, poseA, d.normal, d.point[0], placed, angle, first) ||
      !featureOf(b, poseB, -d.normal, d.point[1], placed, angle, second))
    return false;
  const double rounding = placed + placeRounding(a.margin + b.margin);
  swapped = first.count < second.count;
  if (swapped) return touchOfFeatures(second, poseB, first, poseA, exchanged(d), rounding, touch);
  return touchOfFeatures(first, poseA, second, poseB, d, rounding, touch);
}

Distance exchanged(Distance d) {
  d.normal = -d.normal;
  std::swap(d.point[0], d.point[1]);
  std::swap(d.patch[0], d.patch[1]);
  return d;
}

}  // namespace fcl_stpbv::detail
