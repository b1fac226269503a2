// A part of a mesh during the search: its contents, its convex hull, and the excess of the hull over the
// mesh.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "fcl_stpbv/parts/cell.h"
#include "fcl_stpbv/parts/known_excess.h"
#include "fcl_stpbv/parts/mesh_solid.h"
#include "fcl_stpbv/parts/part_hull.h"
#include "fcl_stpbv/parts/plane_cut.h"

namespace fcl_stpbv::detail {

/// What the search works on: the mesh, and lengths that follow from its size.
struct PartSpace {
  const MeshSolid& mesh;
  double size;                         ///< of the box around the mesh (m)
  double slack;                        ///< corners this near a plane count as on it (m)
  double fine;                         ///< excess that the search does not look below (m)
  double costly;                       ///< what a distance costs, in distances to a usual mesh; at least 1
  std::vector<CutPlane> facets;        ///< flat parts of the mesh
  bool isWhole = true;                 ///< the search sees the mesh itself, not a coarser one
  std::unique_ptr<KnownExcess> known;  ///< what the measures of this search found out

  explicit PartSpace(const MeshSolid& solid);
};

/// A leaf of the binary space partition (BSP) that the cuts make: the mesh's triangles in it, and the corners
/// of its cell that are inside the solid. Or a facet of the mesh, or what cuts left of one, or a convex piece
/// of the inside, by its corners: these have no cell.
struct BspLeaf {
  TriangleSoup soup;
  Cell cell;
  std::vector<Eigen::Vector3d> corners;
  std::vector<CutPlane> path;  ///< the cuts that made it, normals towards it
  bool isFacet = false;
  int group = 0;  ///< the group of the mesh's pieces that it was cut from
};

using BspLeaves = std::vector<std::shared_ptr<const BspLeaf>>;

/// Leaves whose common hull is one part.
struct Part {
  BspLeaves leaves;
  PartHull hull;
  MeshExcess excess;
  double resolution = 0;  ///< that the excess is known to (m), if `queries` were enough
  long queries = 0;       ///< of distances that its last measure could spend
  double judged = -1;     ///< bound (m) of which it was last measured whether it is within
};

using PartPtr = std::shared_ptr<Part>;

/// How accurately to measure a part's excess: to `resolution`, but less accurately if it is above `enough`
/// (m), and with at most `queries` distances plus two for each triangle of its surface.
struct Measure {
  double resolution;
  double enough = std::numeric_limits<double>::infinity();
  long queries = 1000;
  double relative = 0.1;  ///< part of the excess that the resolution grows by
};

/// Measures a part's excess anew.
void measureAgain(Part& part, const PartSpace& space, const Measure& measure);

/// The part of these leaves.
Part makePart(BspLeaves leaves, const PartSpace& space, const Measure& measure);

/// Likewise, where the hull of the leaves' triangles is known.
Part makePart(BspLeaves leaves, PartHull hull, const PartSpace& space, const Measure& measure);

/// The hull of two parts together.
Part joined(const Part& a, const Part& b, const PartSpace& space, const Measure& measure);

/// Splits a part's leaves by a plane: first those on the side to which its normal points, then the others. A
/// leaf with triangles on one side only is not split, so each point of the mesh stays in a leaf.
std::pair<BspLeaves, BspLeaves> cut(const Part& part, const CutPlane& plane, const PartSpace& space);

/// The hulls of the triangles that cut() would leave on either side, without making the leaves.
struct CutHulls {
  PartHull above, below;
  /// Sum of their volumes, and up to 0.2 % more the longer they are: no single cut lowers the volume of a
  /// ring's hull, and cuts across it lead on (m^3).
  double volume = 0;
};

/// Nothing where the plane leaves nothing on one side.
std::optional<CutHulls> hullsOfCut(const Part& part, const CutPlane& plane, const PartSpace& space);

}  // namespace fcl_stpbv::detail
