// Distance of a point from a triangle mesh, and whether the mesh encloses it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <limits>
#include <vector>

#include "fcl_stpbv/parts/mesh_pieces.h"

namespace fcl_stpbv {

/// The three corners (m).
using Triangle = std::array<Eigen::Vector3d, 3>;

/// Point of a triangle nearest to `p`; the triangle may be a segment or a point. To rounding, and always a
/// point of the triangle, so that a distance made of it is never too small by more than rounding.
Eigen::Vector3d nearestOf(const Triangle& triangle, const Eigen::Vector3d& p);

/// A mesh as a solid: its triangles and all that its closed pieces enclose. The solid's boundary lies in the
/// triangles, so bodies that stay outside each other are as far apart as their triangles are.
class MeshSolid {
 public:
  /// Where a point is.
  enum class Side { outside, enclosed, unsure };

  /// @throws Error as meshPieces() does.
  explicit MeshSolid(const TriangleMesh& mesh);

  /// All triangles (m).
  const std::vector<Triangle>& triangles() const { return triangles_; }
  /// Which triangles hang together.
  const MeshPieces& pieces() const { return pieces_; }
  /// Whether every piece is closed, so that the mesh has an inside everywhere.
  bool closed() const { return pieces_.closedPieces() == pieces_.pieces(); }
  /// Least coordinates of a box that holds the mesh (m).
  const Eigen::Vector3d& low() const { return nodes_[0].low; }
  /// Largest coordinates of that box (m).
  const Eigen::Vector3d& high() const { return nodes_[0].high; }

  /// The nearest triangle, or one of them.
  struct Nearest {
    double distance;  ///< from the surface (m)
    int triangle;     ///< index into triangles()
  };
  /// `guess` is a triangle that is probably near, or -1; the triangles looked at are added to `tried`.
  Nearest nearest(const Eigen::Vector3d& p, int guess = -1, long* tried = nullptr) const;

  /// Calls `visit` with triangles until it says false: all whose boxes meet the box from `low` to `high`.
  /// Whether it never did.
  bool within(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
              const std::function<bool(int)>& visit) const;

  /// Which side of the closed pieces a point is on, by crossings of a ray. `unsure` is for points on the
  /// surface to rounding, and where every ray tried touches an edge.
  Side side(const Eigen::Vector3d& p) const;

  /// Whether the mesh has the point inside: certain where a closed piece has it (side()); by pieces that are
  /// not closed, and where side() is unsure, a judgement: triangles go round it at least half a time
  /// (generalized winding number, Jacobson et al. 2013).
  bool holds(const Eigen::Vector3d& p) const;

 private:
  struct Node {
    Eigen::Vector3d low, high;
    int begin, end;  // among order_
    int left = -1, right = -1;
  };
  int build(int begin, int end);
  /// The triangles in boxes that are not missed, until `visit` returns false. @returns whether it never did.
  template <class Misses, class Visit>
  bool each(const Misses& misses, const Visit& visit) const;
  template <class Visit>
  bool alongRay(const Eigen::Vector3d& p, const Eigen::Vector3d& direction, Visit visit) const;
  Side side(const Eigen::Vector3d& p, const Eigen::Vector3d& direction) const;

  MeshPieces pieces_;
  std::vector<Triangle> triangles_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace fcl_stpbv
