// A triangle mesh as a solid: its connected pieces, the distance of a point from it, whether it encloses a
// point, and the largest distance of a surface around it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <limits>
#include <vector>

#include "fcl_stpbv/volume/tessellate.h"

namespace fcl_stpbv {

/// A mesh split into connected pieces: triangles that share edges. First the triangles are oriented like
/// their neighbours. A piece is closed if each of its edges is then traversed equally often in both
/// directions. Its winding number about a point is then an integer, and the piece encloses the point if that
/// number is not 0. Copies of a triangle, in either orientation, count once. They do not count at all in a
/// wall between two bodies or in a two-sided sheet, which has no inside. Flipped faces, nested shells and
/// holes are common in robots' meshes, so they are no errors.
struct MeshPieces {
  std::vector<Eigen::Vector3d> vertices;  ///< each point once (m)
  /// Triangles after orientation, as indices into `vertices`. Copies are removed, and so are degenerate
  /// triangles that are just an edge or a corner of another one. Sheets keep both sides. A vertex that no
  /// other triangle used becomes a triangle with three equal corners.
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> piece;    ///< index of the piece of each triangle
  std::vector<char> closed;  ///< whether each piece is closed
  /// Number of pieces.
  int pieces() const { return static_cast<int>(closed.size()); }
  /// Number of closed pieces.
  int closedPieces() const;
};

/// @throws Error for a mesh without triangles, an index out of range or a coordinate that is not finite.
MeshPieces meshPieces(const TriangleMesh& mesh);

/// A triangle by its three corners (m).
using Triangle = std::array<Eigen::Vector3d, 3>;

/// A mesh as a solid: its triangles and the space that its closed pieces enclose. The boundary of the solid
/// consists of triangles, so the distance of two solids that do not overlap is the distance of their
/// triangles.
class MeshSolid {
 public:
  /// Where a point is.
  enum class Side { outside, enclosed, unsure };

  /// @throws Error as meshPieces() does.
  explicit MeshSolid(const TriangleMesh& mesh);

  /// All triangles (m).
  const std::vector<Triangle>& triangles() const { return triangles_; }
  /// The connected pieces of the mesh.
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
  /// The triangle nearest to `p` (m). `guess` is a triangle that is probably near, or -1. The search may stop
  /// at any triangle within `enough` (m). The number of triangles tested is added to `tried`.
  Nearest nearest(const Eigen::Vector3d& p, int guess = -1, double enough = 0, long* tried = nullptr) const;

  /// Distance of a point from one triangle (m).
  double distance(const Eigen::Vector3d& p, int triangle) const;

  /// Calls `visit` with each triangle whose box meets the box from `low` to `high` (m). Stops when `visit`
  /// returns false. @returns whether `visit` never returned false.
  bool within(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
              const std::function<bool(int)>& visit) const;

  /// Whether the closed pieces enclose a point, by counting the crossings of a ray. `unsure` for points on
  /// the surface up to rounding, and if every ray tried touches an edge.
  Side side(const Eigen::Vector3d& p) const;

  /// Whether the point is inside the mesh. This is certain for a point inside a closed piece (see side()).
  /// For pieces that are not closed, and if side() is `unsure`, it is an estimate: the generalized winding
  /// number (Jacobson et al. 2013) is at least one half.
  bool holds(const Eigen::Vector3d& p) const;

 private:
  struct Node {
    Eigen::Vector3d low, high;
    int triangle;  // for a leaf
    int left = -1, right = -1;
  };
  /// A triangle in the form in which distances from it are computed. They are exact up to
  /// rounding, and never too small by more than that.
  struct Foot {
    Eigen::Vector3d a, u, v;  ///< a corner, and from there to the others (m)
    /// The products of these with p - a are barycentric coordinates of p's foot. NaN if the triangle has no
    /// plane.
    Eigen::Vector3d alongU, alongV;
    bool isThin;  ///< whether rounding may put a foot that is inside beyond a side
    explicit Foot(const Triangle& triangle);
    double squaredDistance(const Eigen::Vector3d& p) const;
  };
  int build(std::vector<int>::iterator begin, std::vector<int>::iterator end);
  /// Visits the triangles in boxes that `misses` does not exclude, until `visit` returns false. @returns
  /// whether `visit` never returned false.
  template <class Misses, class Visit>
  bool each(const Misses& misses, const Visit& visit) const;
  template <class Visit>
  bool alongRay(const Eigen::Vector3d& p, const Eigen::Vector3d& direction, Visit visit) const;
  Side side(const Eigen::Vector3d& p, const Eigen::Vector3d& direction) const;

  MeshPieces pieces_;
  std::vector<Triangle> triangles_;
  std::vector<Foot> feet_;  // one for each triangle
  std::vector<Node> nodes_;
};

/// Accuracy of the bounds on an excess, and limits of the search.
struct ExcessOptions {
  /// The upper bound exceeds the true value by at most this length (m) ...
  double absolute = 1e-5;
  /// ... plus this fraction of it.
  double relative = 1e-3;
  /// Limit on the number of distance queries. When it is reached, the bounds are wider.
  long queries = 1000000;
  /// True: points inside the mesh have distance 0; false: all distances are from the triangles.
  bool filled = true;
  /// Stops as soon as the excess is proven to be larger than this (m).
  double enough = std::numeric_limits<double>::infinity();
  /// Upper bound on the distance of the surface's corners from the mesh, if one is known (m).
  double corners = std::numeric_limits<double>::infinity();
};

/// Options for an estimate to display: takes a tenth of a second, and is within 2 % and 0.01 mm, unless the
/// limit on the queries ends it first.
inline ExcessOptions quickExcess(bool filled) {
  ExcessOptions options;
  options.relative = 0.02;
  options.queries = 20000;
  options.filled = filled;
  return options;
}

/// Bounds on the largest distance of a surface's points from a mesh: lower <= true value <= upper.
struct MeshExcess {
  double upper = 0;                ///< certified upper bound (m)
  double lower = 0;                ///< certified lower bound: the distance of the point `where` (m)
  Eigen::Vector3d where{0, 0, 0};  ///< a point of the surface (m)
};

/// Bounds the largest distance of the surface from the mesh, by branch and bound over the surface's
/// triangles. A triangle has two upper bounds, and the smaller one is used. First: the distance at its centre
/// plus its radius, because the distance is 1-Lipschitz. Second: the largest distance of its corners from the
/// mesh triangle that is nearest to its centre, because the distance from a convex set is largest at a
/// corner.
MeshExcess excessOf(const std::vector<Triangle>& surface, const MeshSolid& mesh,
                    const ExcessOptions& options = {});

/// excessOf() for the surface of the convex hull of a cloud (m).
/// @throws Error as hullTriangles() does.
MeshExcess hullExcess(const std::vector<Eigen::Vector3d>& points, const MeshSolid& mesh,
                      const ExcessOptions& options = {});

/// The triangles of the convex hull of a cloud. A flat hull has two sides. A segment or a point gives one
/// triangle without area.
/// @throws Error for an empty cloud or a coordinate that is not finite.
std::vector<Triangle> hullTriangles(const std::vector<Eigen::Vector3d>& points);

}  // namespace fcl_stpbv
