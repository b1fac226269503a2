// An STP-BV's core seen along one normal, and the climb to the normal with the widest gap to a feature.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "fcl_stpbv/convex/support.h"
#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {

/// The core along the unit normal `n`: its supporting plane, its point and how it curves there. Body frame.
struct VolumeView {
  Eigen::Vector3d n;
  int patch;
  Eigen::Vector3d anchor;  ///< the patch's
  double rise;             ///< height of the core's supporting plane above the anchor (m)
  Eigen::Vector3d point;   ///< core point

  /// Height of `y` above the core's supporting plane (m).
  double gap(const Eigen::Vector3d& y) const { return n.dot(y - anchor) - rise; }
};

/// Looks at one patch along `n`, its formula continued past its own region of normals.
inline VolumeView viewPatch(const StpBv& body, const Eigen::Vector3d& n, int index) {
  const Patch patch = body.patch(index);
  const PatchKind kind = body.kind(index);
  const Radii core{0.0, body.radii().rho, body.radii().rho};
  return {n, index, patch.anchor, supportAboveAnchor(patch, kind, core, n),
          corePoint(patch, kind, body.radii(), n)};
}

/// Looks at the volume along `n`; the owner is sought from the patch `hint` (-1: anywhere). Counts patches
/// changed.
inline VolumeView viewVolume(const StpBv& body, const Eigen::Vector3d& n, int hint, int& steps) {
  const int index = body.owner(n, hint);
  steps += index != hint;
  return viewPatch(body, n, index);
}

/// An STP-BV's core as a body of the support concept (convex/support.h). Looks for each normal's patch from
/// the last.
struct StpBvCore {
  const StpBv& body;
  int patch;   ///< the last one; -1: none
  int& steps;  ///< counts patches changed

  SupportPoint supportPoint(const Eigen::Vector3d& n) {
    const VolumeView view = viewVolume(body, n, patch, steps);
    patch = view.patch;
    return {view.point, view.anchor, view.rise, view.patch};
  }
};

/// Derivative of the core's point with the normal, d y = W d n (docs/theory.md, 6: radii of curvature beyond
/// the core).
inline Eigen::Matrix3d curvatureRadii(const StpBv& body, const VolumeView& view) {
  const PatchKind kind = body.kind(view.patch);
  const double rho = body.radii().rho;
  if (kind == PatchKind::vertex) return Eigen::Matrix3d::Zero();
  Eigen::Matrix3d w = rho * Eigen::Matrix3d::Identity();
  if (kind == PatchKind::edge) {
    const Patch patch = body.patch(view.patch);
    const double v = view.n.dot(patch.axis);
    const double c = std::sqrt(std::max(1.0 - v * v, 1e-30));
    const Eigen::Vector3d around = patch.axis.cross(view.n) / c;
    w -= (patch.kappa / c) * around * around.transpose();
  }
  return w;
}

/// Scale below which numbers about one pair are rounding.
struct Rounding {
  double gap;     ///< of a gap (m)
  double across;  ///< of a difference of core points across the normal: a face's moves rho per ulp of it (m)
};

}  // namespace fcl_stpbv
