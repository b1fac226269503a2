// The gap between the cores of two patches in one frame, along a normal.
#pragma once

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

}  // namespace fcl_stpbv::detail
