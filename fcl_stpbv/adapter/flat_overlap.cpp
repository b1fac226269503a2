#include "fcl_stpbv/adapter/flat_overlap.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fcl_stpbv/adapter/meridian.h"
#include "fcl_stpbv/distance/first_corners.h"
#include "fcl_stpbv/distance/polytope.h"

namespace fcl_stpbv {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr double kRelative = 1e-6;  // of the depth, for round bodies
constexpr int kPoints = 390;        // what the polytope has room for, less a few
constexpr int kAttempts = 4;

/// The difference B - A of the two cores in A's frame, by its furthest points; remembers the least overlap.
struct Difference {
  const Shape& a;
  const Shape& b;
  Matrix3d rotation;
  Vector3d translation;
  double gap = -std::numeric_limits<double>::infinity();  // widest seen
  Vector3d normal{0, 0, 1}, onA{0, 0, 0};                 // its normal, from A to B, and A's point there

  struct Point {
    Vector3d w, onA;
  };

  /// The furthest point along `m`, of any length but zero.
  Point furthest(const Vector3d& m) {
    const Vector3d n = -m.normalized();
    const Vector3d p = a.support(n);
    const Vector3d w = rotation * b.support(-(rotation.transpose() * n)) + translation - p;
    if (n.dot(w) > gap) {
      gap = n.dot(w);
      normal = n;
      onA = p;
    }
    return {w, p};
  }
};

/// A's part of the face's point nearest to the origin.
Vector3d onFace(const std::array<Difference::Point, 3>& c, const Vector3d& nearest) {
  const Vector3d e = c[1].w - c[0].w, f = c[2].w - c[0].w, n = e.cross(f), p = nearest - c[0].w;
  const double area = n.squaredNorm();
  Vector3d weight(0.0, p.cross(f).dot(n) / area, e.cross(p).dot(n) / area);
  weight[0] = 1.0 - weight[1] - weight[2];
  weight = weight.cwiseMax(0.0);
  if (!(weight.sum() > 0.0) || !weight.allFinite()) return c[0].onA;
  weight /= weight.sum();
  return weight[0] * c[0].onA + weight[1] * c[1].onA + weight[2] * c[2].onA;
}

}  // namespace

Distance flatOverlap(const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b,
                     const Eigen::Isometry3d& poseB) {
  Distance result;
  result.lower = -std::numeric_limits<double>::infinity();
  result.upper = std::numeric_limits<double>::infinity();
  if (a.unbounded() || b.unbounded() || !a.valid() || !b.valid()) return result;
  Difference d{a, b, poseA.linear().transpose() * poseB.linear(),
               poseA.linear().transpose() * (poseB.translation() - poseA.translation())};
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() *
                          (d.translation.norm() + a.centre.norm() + a.reach + b.centre.norm() + b.reach);
  if (!(rounding < 1e100)) return result;

  const auto solved = [&](double depth) {
    return -d.gap - depth <= std::max(rounding, 0.5 * kRelative * depth);
  };
  double upper = 0.0;  // the cores overlap
  Meridian plane;
  if (commonMeridian(a, b, d.rotation, d.translation, plane)) {
    // As deep towards all generators as towards one: more than a polytope has room for, in the plane an edge.
    const MeridianDepth inner =
        meridianDepth(plane, rounding, [&](const Vector3d& m) { return d.furthest(m); });
    upper = std::min(upper, -inner.depth);
    d.onA = inner.onA;
  }
  std::array<Difference::Point, kPoints> point;
  std::array<Difference::Point, 4> first;
  // Rounding may spoil a polytope, of slivers along edges and generators: another start makes other faces.
  for (int attempt = 0; attempt < kAttempts && !solved(-upper); ++attempt) {
    const Matrix3d turn = Eigen::AngleAxisd(attempt, Vector3d(0.48, 0.6, 0.64)).toRotationMatrix();
    if (!firstCorners([&](const Vector3d& m) { return d.furthest(turn * m); }, rounding, first)) break;
    std::copy(first.begin(), first.end(), point.begin());
    int points = 4;
    Polytope polytope({first[0].w, first[1].w, first[2].w, first[3].w}, Polytope::Origin::anywhere);
    while (polytope.sound() && points < kPoints) {
      const Polytope::Face face = polytope.nearest();
      // Inside the difference, so with the origin inside it no direction leads out sooner.
      upper = std::min(upper, -face.distance);
      const double before = d.gap;
      const Difference::Point next = d.furthest(face.normal);
      if (d.gap > before || -d.gap - face.distance <= rounding) {
        const auto at = [&](std::size_t i) { return point[static_cast<std::size_t>(face.corner[i])]; };
        d.onA = onFace({at(0), at(1), at(2)}, face.distance * face.normal);
      }
      if (solved(face.distance)) break;
      if (!(face.normal.dot(next.w) - face.distance > rounding)) break;
      point[static_cast<std::size_t>(points++)] = next;
      polytope.expand(next.w);
    }
  }

  const double margins = a.margin + b.margin;
  upper = std::max(upper, d.gap);
  result.status = upper - d.gap <= rounding ? DistanceStatus::exact : DistanceStatus::bounded;
  result.distance = result.lower = d.gap - margins;
  result.upper = upper - margins;
  result.normal = (poseA.linear() * d.normal).normalized();
  result.point[0] = poseA * Vector3d(d.onA + a.margin * d.normal);
  result.point[1] = result.point[0] + result.distance * result.normal;
  return result;
}

Distance planeDistance(const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b,
                       const Eigen::Isometry3d& poseB) {
  Distance result;
  result.lower = -std::numeric_limits<double>::infinity();
  result.upper = std::numeric_limits<double>::infinity();
  if (!a.unbounded() || b.unbounded() || !a.valid() || !b.valid()) return result;
  const Matrix3d rotation = poseA.linear().transpose() * poseB.linear();
  const Vector3d translation = poseA.linear().transpose() * (poseB.translation() - poseA.translation());
  const auto side = [&](const Vector3d& n, double offset) {
    const Vector3d p = rotation * b.support(-(rotation.transpose() * n)) + translation - b.margin * n;
    const double distance = n.dot(p) - offset;
    if (result.status != DistanceStatus::invalid && !(distance > result.distance)) return;
    result.status = DistanceStatus::exact;
    result.distance = result.lower = result.upper = distance;
    result.normal = (poseA.linear() * n).normalized();
    result.point = {poseA * Vector3d(p - distance * n), poseA * p};
  };
  const Vector3d n = a.normal.normalized();
  if (!std::isfinite(translation.sum())) return result;
  side(n, a.offset);
  if (a.kind == ShapeKind::plane) side(-n, -a.offset);
  return result;
}

}  // namespace fcl_stpbv
