// Candidate planes for cutting a part.
#pragma once

#include <vector>

#include "fcl_stpbv/parts/part.h"

namespace fcl_stpbv::detail {

/// The planes of the mesh's flat parts. `facetOf` receives for each triangle the index of its flat part.
std::vector<CutPlane> flatParts(const MeshSolid& mesh, double slack, std::vector<int>& facetOf);

/// The planes are perpendicular to the coordinate axes and the part's principal axes, in even steps; through
/// the point that is farthest from the mesh; and along the largest flat parts of the mesh, which often are
/// the faces that make a designed body concave.
std::vector<CutPlane> cutPlanes(const Part& part, const PartSpace& space);

}  // namespace fcl_stpbv::detail
