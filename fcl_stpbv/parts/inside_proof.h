// Whether parts cover the inside of a mesh also where they hold no corners of their cells.
#pragma once

#include <optional>
#include <vector>

#include "fcl_stpbv/parts/cell.h"
#include "fcl_stpbv/parts/mesh_solid.h"
#include "fcl_stpbv/parts/plane_cut.h"

namespace fcl_stpbv::detail {

/// A convex hull as planes with normals outwards. Of a flat one the plane that it lies in alone; none of a
/// line or a point.
using HullPlanes = std::vector<CutPlane>;
inline bool isFlat(const HullPlanes& hull) { return hull.size() < 4; }

/// The planes of a cloud's hull, moved outwards by `cover` (m) where it is not flat.
HullPlanes hullPlanes(const std::vector<Eigen::Vector3d>& points, double cover);

/// What the solid has in `cell` outside all of the hulls, which together hold the mesh's triangles: convex
/// pieces, thinner ones than `slack` (m) let go. Nothing where it took too many pieces to tell.
std::optional<std::vector<Cell>> uncoveredInside(const Cell& cell, const std::vector<HullPlanes>& hulls,
                                                 const MeshSolid& mesh, double slack);

/// True where every point of the solid in `cell` is in one of the hulls, which together
/// hold the mesh's triangles. False may also mean that it took too many pieces to tell.
/// Pieces thinner than `slack` (m) are let go.
bool isInsideCovered(const Cell& cell, const std::vector<HullPlanes>& hulls, const MeshSolid& mesh,
                     double slack);

}  // namespace fcl_stpbv::detail
