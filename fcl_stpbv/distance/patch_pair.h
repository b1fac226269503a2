// Two patches in one frame: the gap between them along a normal, and the normal where it is widest.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "fcl_stpbv/volume/patch.h"

namespace fcl_stpbv {

/// A patch with all that its formula needs, in whatever frame its anchor and axis are given.
struct PosedPatch {
  Patch patch;
  PatchKind kind;
  const Radii* radii;  ///< the body's
};

/// The gap between two patches along one normal, without their margins.
struct CoreGap {
  double value;                ///< between the supporting planes, `s(n) + r_A + r_B` (m)
  Eigen::Vector3d point;       ///< the first patch's, in the patches' frame (m)
  Eigen::Vector3d difference;  ///< from it to the second patch's (m)

  /// Gradient of the gap over the sphere of normals: what of the points' difference lies across `n` (m).
  Eigen::Vector3d across(const Eigen::Vector3d& n) const { return difference - difference.dot(n) * n; }
};

/// The gap along the unit normal `n` from `a` to `b`, the patches continued over the whole sphere of normals
/// (docs/theory.md, 5).
CoreGap coreGap(const PosedPatch& a, const PosedPatch& b, const Eigen::Vector3d& n);

/// The unit normal at which the gap is widest, seen from `n`: closed form for spheres and one torus, Newton
/// on the sphere for two tori (docs/theory.md, 5). Where every normal is as good (coincident centres), `n`
/// itself.
inline Eigen::Vector3d widestNormal(const PosedPatch& a, const PosedPatch& b, const Eigen::Vector3d& n);

/// The same where at least one of the patches is an edge's.
Eigen::Vector3d widestNormalOfEdge(const PosedPatch& a, const PosedPatch& b, const Eigen::Vector3d& n);

/// Radii of curvature of the patch's core at its outward normal `n`, as a matrix on the tangent plane: the
/// second derivative of its support function (m).
Eigen::Matrix3d coreCurvature(const PosedPatch& p, const Eigen::Vector3d& n);

/// `d` of unit length, or `otherwise` where it has none.
inline Eigen::Vector3d normalizedOr(const Eigen::Vector3d& d, const Eigen::Vector3d& otherwise) {
  const double length2 = d.squaredNorm();
  return length2 > std::numeric_limits<double>::min() ? Eigen::Vector3d(d / std::sqrt(length2)) : otherwise;
}

inline Eigen::Vector3d widestNormal(const PosedPatch& a, const PosedPatch& b, const Eigen::Vector3d& n) {
  if (a.kind == PatchKind::edge || b.kind == PatchKind::edge) return widestNormalOfEdge(a, b, n);
  // Two spheres: along the line of their centres, a face's being `rho` behind its anchor; a vertex has no axis.
  const Eigen::Vector3d from = a.patch.anchor - a.radii->rho * a.patch.axis;
  return normalizedOr(b.patch.anchor - b.radii->rho * b.patch.axis - from, n);
}

}  // namespace fcl_stpbv
