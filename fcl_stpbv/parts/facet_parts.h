// Parts from below: the mesh's flat parts, joined with their neighbours.
#pragma once

#include <vector>

#include "fcl_stpbv/parts/part_search.h"

namespace fcl_stpbv::detail {

/// Flat parts of the mesh, each in one piece, joined with neighbours while their common hull is within
/// `bound` (m) of the mesh, and on until few more than `most` are left. They hold all triangles; what the
/// mesh encloses is for the caller to prove. None where the mesh has too many flat parts for that.
PartSearch::Parts facetParts(const std::vector<TriangleSoup>& groups, const PartSpace& space, int most,
                             double bound);

}  // namespace fcl_stpbv::detail
