// Bottom-up convex decomposition: joins the mesh's facets (flat parts) with their neighbours.
#pragma once

#include <vector>

#include "fcl_stpbv/parts/part_search.h"

namespace fcl_stpbv::detail {

/// Joins connected facets with neighbours as long as the common hull is within `bound` (m) of the mesh, and
/// further until `most` parts are left. Returns the sets of parts on the way, each a little coarser than the
/// one before. Each set contains all triangles. The caller must prove that it also covers the inside of the
/// mesh. Empty if the mesh has too many facets or loose pieces.
std::vector<PartSearch::Parts> facetParts(const std::vector<TriangleSoup>& groups, const PartSpace& space,
                                          int most, double bound);

}  // namespace fcl_stpbv::detail
