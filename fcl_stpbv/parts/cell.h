// The convex cell of space that remains for a part after plane cuts, and its corners inside the mesh's solid.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "fcl_stpbv/parts/mesh_solid.h"
#include "fcl_stpbv/parts/plane_cut.h"

namespace fcl_stpbv::detail {

/// A box cut by planes. Its corners matter for this reason: an extreme point of the solid within the cell
/// lies either on the solid's surface, or it is a corner of the cell inside the solid. So the convex hull of
/// the surface's triangles within the cell and of those corners contains all of the solid within the cell.
class Cell {
 public:
  Cell() = default;  ///< an empty cell, for meshes that enclose nothing
  /// The box around the mesh, a little larger.
  explicit Cell(const MeshSolid& mesh);

  /// The part of the cell on the side to which the plane's normal points. If a mesh is given, each new corner
  /// is tested for being inside it. Corners within `slack` (m) of the plane count as on it.
  Cell above(const CutPlane& plane, double slack, const MeshSolid* mesh = nullptr) const;

  /// Least and largest height of its corners over a plane (m).
  std::pair<double, double> reach(const CutPlane& plane) const;
  /// Whether the cell has no inside.
  bool isFlat() const { return faces_.size() < 4; }
  /// The mean of its corners. It is inside if the cell is not flat.
  Eigen::Vector3d middle() const;

  std::vector<Eigen::Vector3d> corners() const;
  /// Corners that the mesh encloses, or that are too near its surface to tell.
  std::vector<Eigen::Vector3d> enclosedCorners() const;

 private:
  struct Corner {
    Eigen::Vector3d point;
    bool enclosed;
  };
  std::vector<Corner> corners_;
  std::vector<std::vector<int>> faces_;  // rings of corners
};

}  // namespace fcl_stpbv::detail
