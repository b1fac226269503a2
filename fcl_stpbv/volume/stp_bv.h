// The sphere-torus-patch bounding volume (STP-BV): its data and its queries.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv {

/// The element of the volume that a patch belongs to.
enum class PatchKind { vertex, edge, face };

/// A piece of the surface: the offset of a point or of a circle (paper III; docs/theory.md, 2).
///
/// Every patch is the set of points `I - kappa w + c n`. Here `n` runs over the patch's unit normals, `w` is
/// the part of `n` perpendicular to `u`, scaled to length 1, and `c` is r or R. `R` may be 10 m or more, but
/// distances must be exact to micrometres. So only lengths near the body are stored: an anchor point at the
/// vertices and, for a face, the unit normal there. Lengths in m, body frame.
struct Patch {
  Eigen::Vector3d anchor;  ///< vertex: its position p; edge: its midpoint I; face: one of its vertices
  /// Vertex: 0; edge: unit vector u from its first to its second vertex; face: (anchor - C)/rho, C the big
  /// sphere's centre.
  Eigen::Vector3d axis;
  double kappa;  ///< radius of the circle of centres, sqrt(rho^2 - l^2/4) for an edge, else 0
  double sine;   ///< edge of length l: (l/2)/rho, the largest |n.u| of its normals; else 0
};

/// The radii that all patches of one body share. The volume is defined by `r` and by `rho` as it was rounded
/// to a double, so its big radius is `R` to rounding only. Next to the smallest R (1 + 1e-12 times it) that
/// matters: the volume of the exact R - r would have its surface up to 4e-12 m elsewhere.
struct Radii {
  double r;    ///< small radius, the margin (m)
  double R;    ///< big radius (m)
  double rho;  ///< R - r, rounded: radius of the balls whose intersection is the core (m)
};

namespace detail {
struct QueryTables;
}

/// Radii for building a volume (paper III).
struct StpBvOptions {
  double r = 0.01;  ///< radius of the small spheres, the least margin around the points (m), >= 0
  double R = 10.0;  ///< radius of the big spheres (m); R - r must exceed the minimum enclosing ball's radius
};

/// Strictly convex, C1 body around a cloud of points: a small sphere on each vertex, a part of a torus on
/// each edge, a part of a big sphere on each face (paper III).
///
/// Immutable; any number of threads may query one. All points, normals and directions are in the body's own
/// frame. Lengths are in metres. Normals have unit length and point outward. Queries never throw and never
/// allocate.
class StpBv {
 public:
  using Ptr = std::shared_ptr<const StpBv>;  ///< shared and immutable
  using Ring = std::vector<int>;             ///< a face's vertices, counter-clockwise seen from outside

  /// An edge: its two vertices and the faces on its two sides. On a spindle (two vertices, one edge patch all
  /// around) both faces are -1. The ring of `face[0]` contains the edge in the direction from `vertex[0]` to
  /// `vertex[1]`. `turn` is the angle about the edge from the normals of `face[0]` to those of `face[1]`. It
  /// is 2 pi on a spindle, otherwise at most 2 pi. Two vertices may be joined by several edges.
  struct Edge {
    std::array<int, 2> vertex;  ///< the ends, indices into vertices()
    std::array<int, 2> face;    ///< the faces on its two sides, -1: none
    double turn;                ///< angle between its faces' normals (rad)
  };

  /// Builds the volume of a point cloud (m). A ball of radius `R - r` rolls over the cloud, with all points
  /// inside it. Each position in which it touches three or more points gives a face (paper IV.A, Algorithm
  /// 1). A point that the ball cannot touch lies inside the volume and is not a vertex. Cospherical points
  /// share one k-gon face.
  /// @throws Error for an empty cloud, a coordinate that is not finite, r < 0, R <= r, an R that is too
  /// small, or an R so large that faces are flat to rounding. The message states a usable R.
  static Ptr build(const std::vector<Eigen::Vector3d>& points, const StpBvOptions& options = {});

  /// Makes a volume from its vertices and faces, as they are stored in a file.
  /// @throws Error if they do not describe an STP-BV with these radii: an index is out of range, two vertices
  /// coincide, the faces do not form a closed surface, or a vertex lies outside a face's ball.
  static Ptr assemble(std::vector<Eigen::Vector3d> vertices, std::vector<Ring> faces,
                      const StpBvOptions& options);

  /// The radii r, R and R - r (m).
  const Radii& radii() const { return radii_; }
  /// The centres of the small spheres (m).
  const std::vector<Eigen::Vector3d>& vertices() const { return vertices_; }
  /// The edges; each carries a torus patch.
  const std::vector<Edge>& edges() const { return edges_; }
  /// The faces, each as a ring of vertex indices; each carries a patch of a big sphere.
  const std::vector<Ring>& faces() const { return faces_; }

  /// Unit outward normal of a face's big sphere at one of the face's vertices (`vertex` is an index into
  /// vertices()). On the Gauss sphere it is a corner where regions of normals meet.
  Eigen::Vector3d corner(int face, int vertex) const;

  /// Number of vertices.
  int vertexCount() const { return static_cast<int>(vertices_.size()); }
  /// Number of edges.
  int edgeCount() const { return static_cast<int>(edges_.size()); }
  /// Number of faces.
  int faceCount() const { return static_cast<int>(faces_.size()); }

  /// Number of patches. They are numbered in this order: vertices, edges, further parts of edges, faces. An
  /// edge whose normals turn by more than half a turn is split into several parts, so that each patch's
  /// region of normals is an intersection of half spaces.
  int patchCount() const { return firstFace_ + faceCount(); }
  /// The patch of an edge. If the edge has several parts, it is the patch of the first part.
  int edgePatch(int edge) const { return vertexCount() + edge; }
  /// The patch of a face. A vertex's patch has the vertex's number.
  int facePatch(int face) const { return firstFace_ + face; }
  /// The kind of element that a patch belongs to.
  PatchKind kind(int patch) const {
    return patch < vertexCount() ? PatchKind::vertex : patch < firstFace_ ? PatchKind::edge : PatchKind::face;
  }
  /// A patch by its number, 0 to patchCount() - 1.
  Patch patch(int index) const;

  /// How far the unit normal `n` lies outside the patch's region of normals; <= 0 inside. It is the largest
  /// value over the region's boundaries. A plane between an edge and a face gives a sine; the end of an edge
  /// gives a difference of sines.
  double outside(int patch, const Eigen::Vector3d& n) const;

  /// The patch whose region contains the unit normal `n`. The search walks from patch to patch over their
  /// boundaries. It starts at the patch `hint`, or, if no patch has that number, at a patch from a direction
  /// table.
  int owner(const Eigen::Vector3d& n, int hint = -1) const;

  /// Support function h(n) = max over the body of x.n, for unit `n` (m); infinite if `n` is not finite.
  double support(const Eigen::Vector3d& n, int hint = -1) const;

  /// The surface point whose outward normal is the unit vector `n` (m); the centre if `n` is not finite.
  Eigen::Vector3d surfacePoint(const Eigen::Vector3d& n, int hint = -1) const;

  /// A point well inside the body: the centre of the vertices' minimum enclosing ball (m).
  const Eigen::Vector3d& centre() const { return centre_; }
  /// Radius of a ball about centre() that contains the body: the radius of the vertices' minimum enclosing
  /// ball plus r (m).
  double enclosingRadius() const { return enclosingRadius_; }

  /// Radius of a ball about `centre()` that lies inside the vertices' convex hull (m); 0 if there is none.
  double innerRadius() const { return innerRadius_; }

  /// Upper bound on the absolute coordinates of surface points (m). Bounds on rounding errors use it.
  double extent() const { return extent_; }

  /// Memory that this volume uses, in bytes.
  std::size_t memory() const;

  /// Limit of the big radius for these points and the margin r (m): build() accepts an R above it, except
  /// perhaps one that is above it by no more than rounding (1e-13 of it). @throws Error for points or a
  /// margin that build() refuses for every R.
  static double smallestR(const std::vector<Eigen::Vector3d>& points, double r);

  /// Tables for this library's own queries; not for users.
  const detail::QueryTables& tables() const { return *tables_; }

 private:
  StpBv() = default;
  static Ptr make(std::vector<Eigen::Vector3d> vertices, std::vector<Ring> faces,
                  const StpBvOptions& options);
  void makeEdges();
  void makeInnerRadius();
  void makePatches(detail::QueryTables& tables);
  void makeDirectionTables(detail::QueryTables& tables) const;

  Radii radii_{};
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Edge> edges_;
  std::vector<Ring> faces_;
  std::vector<Eigen::Vector3d> faceNormals_;  // unit, at each ring's first vertex
  int firstFace_ = 0;                         // number of the first face's patch
  std::shared_ptr<const detail::QueryTables> tables_;
  Eigen::Vector3d centre_{0, 0, 0};
  double enclosingRadius_ = 0, innerRadius_ = 0, extent_ = 0;
};

/// A volume with few vertices around `points` (m). Every point lies at least `options.r` below its surface,
/// and the volume exceeds the points' convex hull by at most `overCover` (m). Its big radius is `options.R`.
/// Its small radius is larger than `options.r`, so that it also covers the points that are no vertices. If a
/// sphere or a spindle (one or two vertices) is enough, the result is one. Otherwise vertices are added where
/// the points stick out most, then removed while the limit allows. The number of vertices is small, but not
/// proven to be minimal. `verify(volume, points, options.r)` checks the margin. The time grows at least with
/// the square of the number of vertices: 5 s for 500 vertices all over a sphere, half a minute for 1000.
/// @throws Error as StpBv::build() does, and if the volume with all points as vertices already exceeds the
/// limit. The message states its over-cover.
StpBv::Ptr reduce(const std::vector<Eigen::Vector3d>& points, const StpBvOptions& options, double overCover);

}  // namespace fcl_stpbv
