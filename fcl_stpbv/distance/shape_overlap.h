// When no feature search certifies: whether the cores overlap at all, and how deep.
#pragma once

#include "fcl_stpbv/distance/shape_query.h"

namespace fcl_stpbv {

/// What the cut search found.
struct WidestGap {
  Nearest at;    ///< the best normal seen; `gap` is the true gap along it
  double bound;  ///< no normal has a wider one (m)
  bool overlap;  ///< the cores have a common point, beyond rounding
  bool solved;   ///< the remaining normals are one to rounding
};

/// Halves the convex cone of remaining normals until it is one normal to rounding, with support points of the
/// two whole bodies alone (docs/theory.md, 5). Slow, sure.
WidestGap widestGapByCuts(ShapeQuery& q, const StartNormal& start);

/// How deep overlapping cores are in each other: grows a polytope inside their difference where its surface
/// is nearest to the origin (van den Bergen 2001). `at` is the normal with the least overlap seen, `bound`
/// holds for every normal.
WidestGap leastOverlap(ShapeQuery& q, const StartNormal& start);

}  // namespace fcl_stpbv
