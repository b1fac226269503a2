// Parts that grow until they hold what a mesh encloses.
#pragma once

#include "fcl_stpbv/parts/part_search.h"

namespace fcl_stpbv::detail {

/// Parts whose hulls hold all of the mesh's triangles, grown or with more of them, `most` at most, so that
/// they hold what it encloses too. Nothing where that takes one farther from the mesh than `bound` (m), or
/// too many steps.
PartSearch::Parts filled(PartSearch::Parts parts, const PartSpace& space, int most, double bound);

}  // namespace fcl_stpbv::detail
