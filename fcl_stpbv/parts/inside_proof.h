// Proves that parts cover the inside of a mesh, even if they do not contain the corners of their cells.
#pragma once

#include <optional>
#include <vector>

#include "fcl_stpbv/parts/cell.h"
#include "fcl_stpbv/parts/mesh_solid.h"
#include "fcl_stpbv/parts/plane_cut.h"

namespace fcl_stpbv::detail {

/// A convex hull as planes with outward normals. A flat hull has only the plane in which it lies. A line or a
/// point has none.
using HullPlanes = std::vector<CutPlane>;
inline bool isFlat(const HullPlanes& hull) { return hull.size() < 4; }

/// The planes of a cloud's hull, moved outwards by `cover` (m) if the hull is not flat.
HullPlanes hullPlanes(const std::vector<Eigen::Vector3d>& points, double cover);

/// The part of the solid in `cell` that is outside of all hulls, as convex pieces. The hulls together must
/// contain the mesh's triangles. Pieces thinner than `slack` (m) are ignored. No value if too many pieces
/// would be needed.
std::optional<std::vector<Cell>> uncoveredInside(const Cell& cell, const std::vector<HullPlanes>& hulls,
                                                 const MeshSolid& mesh, double slack);

/// Whether every point of the solid in `cell` is in one of the hulls. The hulls together must contain the
/// mesh's triangles. False may also mean that too many pieces would be needed. Pieces thinner than `slack`
/// (m) are ignored.
bool isInsideCovered(const Cell& cell, const std::vector<HullPlanes>& hulls, const MeshSolid& mesh,
                     double slack);

}  // namespace fcl_stpbv::detail
