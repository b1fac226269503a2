// Two patches in one frame: the gap between them along a normal, and the normal where it is widest.
#pragma once

#include <Eigen/Core>

#include "fcl_stpbv/volume/patch.h"

namespace fcl_stpbv {

/// A patch with all that its formula needs, in whatever frame its anchor and axis are given.
struct PosedPatch {
  Patch patch;
  PatchKind kind;
  Radii radii;
};

/// The pair's gap without the two margins, `s(n) + r_A + r_B` for the patches continued over the whole sphere
/// of normals (docs/theory.md, 5); `n` is unit and points from `a` to `b` (m).
double coreGap(const PosedPatch& a, const PosedPatch& b, const Eigen::Vector3d& n);

/// Core point of `b` with normal `-n` minus core point of `a` with normal `n`: the gradient of `coreGap` is
/// its part across `n` (m).
Eigen::Vector3d coreDifference(const PosedPatch& a, const PosedPatch& b, const Eigen::Vector3d& n);

/// The unit normal at which `coreGap` is largest, seen from `n`: closed form for spheres and one torus,
/// Newton on the sphere for two tori (docs/theory.md, 5). Where every normal is as good (coincident centres),
/// `n` itself.
Eigen::Vector3d widestNormal(const PosedPatch& a, const PosedPatch& b, const Eigen::Vector3d& n);

}  // namespace fcl_stpbv
