// One smooth body for every pair that is checked: which primitives get a smooth cover.
#pragma once

#include <vector>

#include "fcl_stpbv/robot/checked_pairs.h"

namespace fcl_stpbv {

/// Replaces primitives by their smooth covers (primitive_cover.h) until every pair has an STP-BV, which makes
/// its distance C1 (docs/theory.md, 5). A flat capsule is not enough: two of them jump where they turn
/// through parallel, as a capsule does along a box. Bodies that are smooth already are not touched, nor
/// meshes that were asked to stay flat: a pair of two of those stays without.
///
/// Chosen per body: those first whose cover exceeds the primitive least for each pair it settles,
/// then those are taken back, the largest excess first, that the others have made needless.
/// Deterministic; a few more covers than the fewest are possible. `scene` holds the bodies that
/// `pairs` name as obstacles, in their order; null without any. @throws Error for a pair of bodies
/// that do not exist, or a cover that cannot be built.
void coverPrimitives(const std::vector<CheckedPair>& pairs, RobotGeometry& robot,
                     RobotGeometry* scene = nullptr);

}  // namespace fcl_stpbv
