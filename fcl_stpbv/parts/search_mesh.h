// The mesh as the search for convex parts uses it: grouped, and coarser if it is large.
#pragma once

#include <vector>

#include "fcl_stpbv/parts/part.h"

namespace fcl_stpbv::detail {

constexpr std::size_t kSearched = 2500;  ///< triangles that the search looks at

/// The mesh's triangles by group: one a piece where `each`, or all in one. `facetOf`: each triangle's facet.
std::vector<TriangleSoup> meshGroups(const MeshSolid& mesh, const std::vector<int>& facetOf, bool each);

/// At most about kSearched triangles in place of a group's.
TriangleSoup forSearch(const TriangleSoup& soup, const PartSpace& space);

}  // namespace fcl_stpbv::detail
