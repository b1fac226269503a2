// Grows parts until they cover the inside of a mesh.
#pragma once

#include "fcl_stpbv/parts/part_search.h"

namespace fcl_stpbv::detail {

/// Takes parts whose hulls contain all of the mesh's triangles. Grows them or adds parts, up to `most`, until
/// they contain the inside of the mesh too. Empty if that would need a part farther from the mesh than
/// `bound` (m), or too many steps.
PartSearch::Parts filled(PartSearch::Parts parts, const PartSpace& space, int most, double bound);

}  // namespace fcl_stpbv::detail
