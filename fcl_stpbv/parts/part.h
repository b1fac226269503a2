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

/// The data that the search works on: the mesh, and lengths that follow from its size.
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
/// of its cell that are inside the solid. A leaf may also be a facet of the mesh, or a remainder of one after
/// cuts, or a convex piece of the inside, given by its corners. These have no cell.
struct BspLeaf {
  TriangleSoup soup;
  Cell cell;
  std::vector<Eigen::Vector3d> corners;
  std::vector<CutPlane> path;  ///< the cuts that made the leaf, with normals towards it
  bool isFacet = false;
  int group = 0;  ///< the group of the mesh's pieces from which it was cut
};

using BspLeaves = std::vector<std::shared_ptr<const BspLeaf>>;

/// Leaves whose common hull is one part.
struct Part {
  BspLeaves leaves;
  PartHull hull;
  MeshExcess excess;
  double resolution = 0;  ///< accuracy of the known excess (m), if `queries` were enough
  long queries = 0;       ///< number of distances that the last measurement could use
  double judged = -1;     ///< bound (m) for which it was last measured whether the excess is within it
};

using PartPtr = std::shared_ptr<Part>;

/// How accurately to measure a part's excess: to `resolution`, but less accurately if it is above `enough`
/// (m), and with at most `queries` distances plus two for each triangle of its surface.
struct Measure {
  double resolution;
  double enough = std::numeric_limits<double>::infinity();
  long queries = 1000;
  double relative = 0.1;  ///< share of the excess that is added to the resolution
};

/// Measures a part's excess anew.
void measureAgain(Part& part, const PartSpace& space, const Measure& measure);

/// The part of these leaves.
Part makePart(BspLeaves leaves, const PartSpace& space, const Measure& measure);

/// The part of these leaves, if the hull of their triangles is known.
Part makePart(BspLeaves leaves, PartHull hull, const PartSpace& space, const Measure& measure);

/// The hull of two parts together.
Part joined(const Part& a, const Part& b, const PartSpace& space, const Measure& measure);

/// Splits a part's leaves by a plane: first those on the side to which its normal points, then the others. A
/// leaf with triangles on one side only is not split, so each point of the mesh stays in a leaf.
std::pair<BspLeaves, BspLeaves> cut(const Part& part, const CutPlane& plane, const PartSpace& space);

/// The hulls of the triangles that cut() would leave on either side, without making the leaves.
struct CutHulls {
  PartHull above, below;
  /// Sum of their volumes, increased by up to 0.2 % for longer hulls (m^3). The reason: no single cut lowers
  /// the volume of a ring's hull, but cuts across the ring help later cuts.
  double volume = 0;
};

/// The hulls for a cut. No value if the plane leaves nothing on one side.
std::optional<CutHulls> hullsOfCut(const Part& part, const CutPlane& plane, const PartSpace& space);

}  // namespace fcl_stpbv::detail
