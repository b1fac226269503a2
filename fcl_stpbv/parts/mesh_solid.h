// A triangle mesh as a solid: its pieces, the distance of a point from it, whether it encloses the point, and
// how far a surface around it is from it at most.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <limits>
#include <vector>

#include "fcl_stpbv/volume/tessellate.h"

namespace fcl_stpbv {

/// A mesh taken apart into pieces whose triangles share edges. A piece is closed where each of its edges is
/// run through as often one way as the other, after triangles were turned to agree with their neighbours: its
/// winding number about a point then is a whole number, and where that is not 0 the piece encloses the point.
/// Copies of a triangle, in either direction, count once, and not at all in a wall between two bodies or in a
/// sheet with two sides, which has no inside. Flipped faces, nested shells and holes are the rule in robots'
/// meshes, so none of them is an error.
struct MeshPieces {
  std::vector<Eigen::Vector3d> vertices;  ///< each point once (m)
  /// Turned; without copies and without lines that are an edge of another. Sheets have both sides. A point of
  /// no triangle is one of three equal corners.
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> piece;    ///< of each triangle
  std::vector<char> closed;  ///< of each piece
  /// Number of pieces.
  int pieces() const { return static_cast<int>(closed.size()); }
  /// Number of closed pieces.
  int closedPieces() const;
};

/// @throws Error for a mesh without triangles, an index out of range or a coordinate that is not finite.
MeshPieces meshPieces(const TriangleMesh& mesh);

/// The three corners (m).
using Triangle = std::array<Eigen::Vector3d, 3>;

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
  /// Whether a piece is closed, so that the mesh encloses something.
  bool hasInside() const { return pieces_.closedPieces() > 0; }
  /// Least coordinates of a box that holds the mesh (m).
  const Eigen::Vector3d& low() const { return nodes_[0].low; }
  /// Largest coordinates of that box (m).
  const Eigen::Vector3d& high() const { return nodes_[0].high; }

  /// The nearest triangle, or one of them.
  struct Nearest {
    double distance;  ///< from the surface (m)
    int triangle;     ///< index into triangles()
  };
  /// `guess` is a triangle that is probably near, or -1. Any triangle within `enough` (m) will do. The
  /// triangles looked at are added to `tried`.
  Nearest nearest(const Eigen::Vector3d& p, int guess = -1, double enough = 0, long* tried = nullptr) const;

  /// Of a point from one of the triangles (m).
  double distance(const Eigen::Vector3d& p, int triangle) const;

  /// Calls `visit` with each triangle whose box meets the box from `low` to `high`, until it returns false.
  /// @returns whether it never did.
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
    int triangle;  // a leaf's
    int left = -1, right = -1;
  };
  /// A triangle, as distances from it are computed. To rounding, and never too small by more than that.
  struct Foot {
    Eigen::Vector3d a, u, v;  ///< a corner, and from there to the others (m)
    /// Times p - a they are the barycentric coordinates of p's foot; NaN without a plane.
    Eigen::Vector3d alongU, alongV;
    bool isThin;  ///< rounding may say that a foot inside is beyond a side
    explicit Foot(const Triangle& triangle);
    double squaredDistance(const Eigen::Vector3d& p) const;
  };
  int build(std::vector<int>::iterator begin, std::vector<int>::iterator end);
  /// The triangles in boxes that are not missed, until `visit` returns false. @returns whether it never did.
  template <class Misses, class Visit>
  bool each(const Misses& misses, const Visit& visit) const;
  template <class Visit>
  bool alongRay(const Eigen::Vector3d& p, const Eigen::Vector3d& direction, Visit visit) const;
  Side side(const Eigen::Vector3d& p, const Eigen::Vector3d& direction) const;

  MeshPieces pieces_;
  std::vector<Triangle> triangles_;
  std::vector<Foot> feet_;  // of the triangles
  std::vector<Node> nodes_;
};

/// How close a bound is asked for, and when to end.
struct ExcessOptions {
  /// The upper bound is above the truth by at most this (m),
  double absolute = 1e-5;
  /// and this share of it.
  double relative = 1e-3;
  /// Most distances that this may take; then the bound is wider.
  long queries = 1000000;
  bool filled = true;  ///< points that the mesh encloses count 0; else all points from its triangles
  double enough =
      std::numeric_limits<double>::infinity();  ///< stops as soon as the excess is proven larger (m)
  /// Known bound on the distance of the surface's corners from the mesh (m).
  double corners = std::numeric_limits<double>::infinity();
};

/// For a figure to read rather than a proof: a tenth of a second, within 2 % and 0.1 mm as a rule.
inline ExcessOptions quickExcess(bool filled) {
  ExcessOptions options;
  options.relative = 0.02;
  options.queries = 20000;
  options.filled = filled;
  return options;
}

/// Largest distance of a surface's points from a mesh: lower <= truth <= upper. Lengths in m.
struct MeshExcess {
  double upper = 0;                ///< certified upper bound (m)
  double lower = 0;                ///< found at `where` (m)
  Eigen::Vector3d where{0, 0, 0};  ///< a point of the surface (m)
};

/// How far the surface is from the mesh at most, within the options' limits. Branch and bound over the
/// surface's triangles: the distance from the mesh changes by no more than one
/// moves, and that from one convex set, as a triangle is, is largest at a corner; so a triangle's bound is
/// the smaller of the distance at its middle plus its radius, and of its corners' distances from the mesh's
/// triangle next to its middle.
MeshExcess excessOf(const std::vector<Triangle>& surface, const MeshSolid& mesh,
                    const ExcessOptions& options = {});

/// The same of the surface of the convex hull of a cloud.
/// @throws Error as hullTriangles() does.
MeshExcess hullExcess(const std::vector<Eigen::Vector3d>& points, const MeshSolid& mesh,
                      const ExcessOptions& options = {});

/// The triangles of the convex hull's surface; a flat hull has two sides, a segment
/// and a point give one triangle without area.
/// @throws Error for an empty cloud or a coordinate that is not finite.
std::vector<Triangle> hullTriangles(const std::vector<Eigen::Vector3d>& points);

}  // namespace fcl_stpbv
