// Two patches in one frame: the gap between their cores along a normal, and the normal along which it is
// widest.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "fcl_stpbv/convex/local_maximum.h"
#include "fcl_stpbv/volume/patch_view.h"

namespace fcl_stpbv::detail {

/// The gap between two patches along one normal, without their margins.
struct CoreGap {
  double value;   ///< between the supporting planes, `s(n) + r_A + r_B` (m)
  Packed point;   ///< the first patch's, in the patches' frame (m)
  Packed across;  ///< gradient over the sphere of normals: the points' difference across the normal (m)
};

/// The gap along the unit normal `n` from `a` to `b`. The formulas of the patches are used for any normal,
/// also outside of their regions (docs/theory.md, 5).
inline CoreGap coreGap(const PosedPatch& a, const PosedPatch& b, const Packed& n) {
  const CoreView viewA = viewCore(a, n), viewB = viewCore(b, -n);
  const Packed anchors = b.anchor - a.anchor, difference = anchors + viewB.offset - viewA.offset;
  return {dot(n, anchors) - viewA.rise - viewB.rise, a.anchor + viewA.offset,
          difference - dot(difference, n) * n};
}

/// Changes `n` to the widest normal of the patches of two edges, which are tori. If their axes cross, it is a
/// closed form with a few iterations; otherwise Newton's method on the sphere (docs/theory.md, 5).
void turnToWidestOfEdges(const PosedPatch& a, const PosedPatch& b, Packed& n);

/// Radii of curvature of the patch's core at its outward normal `n`, as a matrix on the tangent plane: the
/// second derivative of its support function (m).
Eigen::Matrix3d coreCurvature(const PosedPatch& p, const Eigen::Vector3d& n);

/// Adds to `around` the part of a patch's core around its point with the normal `n`, at a maximum of the gap:
/// the cap of a face's ball, or the arc of an edge. `inside()` returns how far a face's normal is inside its
/// region (a sine).
template <typename Inside>
void addPatch(const PosedPatch& patch, const Eigen::Vector3d& n, const Inside& inside, LocalMaximum& around) {
  const double rho = patch.radii->rho;
  if (patch.kind == PatchKind::face) around.addCap(rho, rho * inside());
  if (patch.kind != PatchKind::edge) return;
  const Eigen::Vector3d u = unpack(patch.axis);
  const double lean = u.dot(n);
  // The sine of the angle from `n` to the arc's end is more than the difference of the two sines.
  around.addArc((u - lean * n) / std::sqrt(1.0 - lean * lean), rho, rho * (patch.sine - std::abs(lean)));
}

/// A direction that is not normalised yet. Tests on which side of a boundary it lies need not wait for the
/// division.
struct UnnormalizedNormal {
  Packed d;
  double length;  ///< of `d`, positive

  Packed unit() const { return d / length; }
};

/// The direction of `d`, or the unit vector `otherwise` if `d` is zero.
inline UnnormalizedNormal unnormalizedOr(const Packed& d, const Packed& otherwise) {
  using Limits = std::numeric_limits<double>;
  const double length2 = dot(d, d);
  if (!(length2 > Limits::min())) return {otherwise, 1.0};
  if (length2 > Limits::max()) {  // bodies of astronomic size
    const Packed small = 1e-150 * d;
    return {small, std::sqrt(dot(small, small))};
  }
  return {d, std::sqrt(length2)};
}

/// A circle and a point (torus against sphere). `d` runs from the first centre to the second; which of the
/// two the circle belongs to does not matter, since it only enters through `kappa |P n|`.
inline UnnormalizedNormal circlePoint(const PosedPatch& circle, const Packed& d, const Packed& n) {
  const double along = dot(d, circle.axis);
  Packed across = d - along * circle.axis;
  double distance2 = dot(across, across);
  const double length2 = along * along + distance2;
  if (distance2 < 0.5 * length2) {
    // If the point is near the axis, `across` has a rounding error along the axis, which the large `kappa`
    // would magnify.
    across -= dot(across, circle.axis) * circle.axis;
    distance2 = dot(across, across);
  }
  if (!(distance2 > 1e-30 * length2)) {  // on the axis all directions across it are equal; keep the last one
    const Packed e = unnormalizedOr(n - dot(n, circle.axis) * circle.axis, n).unit();
    return unnormalizedOr(along * circle.axis + circle.kappa * e, n);
  }
  const double distance = std::sqrt(distance2);
  return unnormalizedOr(distance * along * circle.axis + (distance + circle.kappa) * across, n);
}

/// The normal with the widest gap of two patches, whether or not it is in their regions. A closed form for
/// spheres and one torus; for two tori an iteration from the unit vector `n` (docs/theory.md, 5). If all
/// normals are equally good (coincident centres), the result is `n` itself.
inline UnnormalizedNormal widestNormal(const PosedPatch& a, const PosedPatch& b, const Packed& n) {
  const bool circleA = a.kind == PatchKind::edge, circleB = b.kind == PatchKind::edge;
  if (circleA && circleB) {
    Packed widest = n;
    turnToWidestOfEdges(a, b, widest);
    return {widest, 1.0};
  }
  const Packed d = b.centre() - a.centre();
  return circleA || circleB ? circlePoint(circleA ? a : b, d, n) : unnormalizedOr(d, n);
}

}  // namespace fcl_stpbv::detail
