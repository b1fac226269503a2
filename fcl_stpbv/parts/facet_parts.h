// Parts from below: the mesh's flat parts, joined with their neighbours.
#pragma once

#include <vector>

#include "fcl_stpbv/parts/part_search.h"

namespace fcl_stpbv::detail {

/// Flat parts of the mesh, each in one piece, joined with neighbours while their common hull is within
/// `bound` (m) of the mesh, and on until `most` are left: the sets of parts passed on the way, each a little
/// coarser than the one before. Each set holds all triangles; what the mesh encloses is for the caller to
/// prove. None where the mesh has too many flat parts, or loose pieces, for that.
std::vector<PartSearch::Parts> facetParts(const std::vector<TriangleSoup>& groups, const PartSpace& space,
                                          int most, double bound);

}  // namespace fcl_stpbv::detail
