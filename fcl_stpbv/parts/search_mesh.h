// The mesh as the search for convex parts uses it: grouped, and coarser if it is large.
#pragma once

#include <vector>

#include "fcl_stpbv/parts/part.h"

namespace fcl_stpbv::detail {

constexpr std::size_t kSearched = 2500;  ///< largest number of triangles that the search works on

/// The mesh's triangles in groups: one group per piece if `each`, otherwise one group. `facetOf`: index of
/// each triangle's facet.
std::vector<TriangleSoup> meshGroups(const MeshSolid& mesh, const std::vector<int>& facetOf, bool each);

/// At most about kSearched triangles that replace those of a group.
TriangleSoup forSearch(const TriangleSoup& soup, const PartSpace& space);

}  // namespace fcl_stpbv::detail
