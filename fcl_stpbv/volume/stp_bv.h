// The sphere-torus-patch bounding volume: what it is and what can be asked of it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv {

/// What a patch belongs to.
enum class PatchKind { vertex, edge, face };

/// A piece of the surface, written as the offset of a point or of a circle (paper III; docs/theory.md, 2).
///
/// Every patch is the set `I - kappa w + c n` over its unit normals `n`, `w` the unit part of `n` across `u`.
/// `R` is 10 m and more while answers are micrometres, so only the lengths near the body are stored: an
/// anchor point among the vertices and, for a face, the unit normal there. Lengths in m, body frame.
struct Patch {
  Eigen::Vector3d anchor;  ///< vertex: p; edge: its middle I; face: one of its vertices
  Eigen::Vector3d
      axis;      ///< vertex: 0; edge: unit u from its first to its second vertex; face: (anchor - C)/rho
  double kappa;  ///< radius of the circle of centres, sqrt(rho^2 - l^2/4) for an edge, else 0
  double sine;   ///< edge: l/2 over rho, how far normals lean along it at most, else 0
};

/// The radii all patches of one body share.
struct Radii {
  double r;    ///< small radius, the margin (m)
  double R;    ///< big radius (m)
  double rho;  ///< R - r, radius of the balls whose intersection is the core (m)
};

namespace detail {
struct QueryTables;
}

/// Radii to build a volume with (paper III).
struct StpBvOptions {
  double r = 0.01;  ///< radius of the small spheres, the least margin around the points (m), >= 0
  double R = 10.0;  ///< radius of the big spheres (m); R - r must exceed the minimum enclosing ball's radius
};

/// Strictly convex, C1 body around a cloud of points: a small sphere on each vertex, a part of a torus on
/// each edge, a part of a big sphere on each face (paper III).
///
/// Immutable; any number of threads may query one. All points, normals and directions are in the body's own
/// frame, lengths in metres, normals unit and outward. Queries never throw and never allocate.
class StpBv {
 public:
  using Ptr = std::shared_ptr<const StpBv>;  ///< shared, immutable
  using Ring = std::vector<int>;             ///< a face's vertices, counter-clockwise seen from outside

  /// An edge's two vertices and the faces on its two sides; faces are -1 on a spindle (two vertices, one edge
  /// patch all the way round). `face[0]` runs from `vertex[0]` to `vertex[1]`; `turn` is the angle about the
  /// edge from its normals to those of `face[1]`, below 2 pi, and 2 pi on a spindle. Two vertices may be
  /// joined by several edges.
  struct Edge {
    std::array<int, 2> vertex;  ///< the ends, indices into vertices()
    std::array<int, 2> face;    ///< the faces beside it, -1: none
    double turn;                ///< angle between its faces' normals (rad)
  };

  /// Its faces are those that a ball of radius `R - r` touches from inside as it rolls over the cloud (paper
  /// IV.A, Algorithm 1). Points that it cannot touch are inside and drop out; cospherical ones share one
  /// k-gon face.
  /// @throws Error for an empty cloud, a coordinate that is not finite, r < 0, R <= r, R below the smallest
  /// usable one, and R so large that faces are flat to rounding; the message states the usable one.
  static Ptr build(const std::vector<Eigen::Vector3d>& points, const StpBvOptions& options = {});

  /// Puts a volume together from its own vertices and faces, as a file holds them.
  /// @throws Error where they are not an STP-BV's for these radii: an index out of range, vertices that
  /// coincide, faces that do not close, or a vertex outside a face's ball.
  static Ptr assemble(std::vector<Eigen::Vector3d> vertices, std::vector<Ring> faces,
                      const StpBvOptions& options);

  /// The radii r, R and R - r (m).
  const Radii& radii() const { return radii_; }
  /// The centres of the small spheres (m).
  const std::vector<Eigen::Vector3d>& vertices() const { return vertices_; }
  /// The torus parts' edges.
  const std::vector<Edge>& edges() const { return edges_; }
  /// The vertices of each big sphere's face.
  const std::vector<Ring>& faces() const { return faces_; }

  /// Unit outward normal of a face's big sphere at one of the face's vertices: a corner where regions meet.
  Eigen::Vector3d corner(int face, int vertex) const;

  /// Number of vertices.
  int vertexCount() const { return static_cast<int>(vertices_.size()); }
  /// Number of edges.
  int edgeCount() const { return static_cast<int>(edges_.size()); }
  /// Number of faces.
  int faceCount() const { return static_cast<int>(faces_.size()); }

  /// Patches are numbered vertices first, then edges, then the further parts of edges that turn by more than
  /// half a turn, then faces: each patch's region of normals is the intersection of its boundaries' sides.
  int patchCount() const { return firstFace_ + faceCount(); }
  /// The patch of an edge, the first one where it has several parts.
  int edgePatch(int edge) const { return vertexCount() + edge; }
  /// The patch of a face. A vertex's patch has the vertex's number.
  int facePatch(int face) const { return firstFace_ + face; }
  /// What a patch is part of.
  PatchKind kind(int patch) const {
    return patch < vertexCount() ? PatchKind::vertex : patch < firstFace_ ? PatchKind::edge : PatchKind::face;
  }
  /// A patch by its number, 0 to patchCount() - 1.
  Patch patch(int index) const;

  /// How far the unit normal `n` lies outside the patch's region, <= 0 inside: the largest of what its
  /// boundaries give, a sine for the plane to a face and a difference of sines along an edge.
  double outside(int patch, const Eigen::Vector3d& n) const;

  /// The patch whose region holds the unit normal `n`, found by walking over the boundaries from `hint` (any
  /// patch), or from a direction table when `hint` is negative.
  int owner(const Eigen::Vector3d& n, int hint = -1) const;

  /// Support function h(n) = max over the body of x.n, for unit `n` (m); infinite where `n` is not finite.
  double support(const Eigen::Vector3d& n, int hint = -1) const;

  /// The surface point whose outward normal is the unit vector `n` (m); the centre where `n` is not finite.
  Eigen::Vector3d surfacePoint(const Eigen::Vector3d& n, int hint = -1) const;

  /// A point well inside: the centre of the vertices' minimum enclosing ball (m).
  const Eigen::Vector3d& centre() const { return centre_; }
  /// Radius of a ball about centre() that holds the body: that of the vertices' ball, and r (m).
  double enclosingRadius() const { return enclosingRadius_; }

  /// Radius of a ball about `centre()` inside the vertices' hull, 0 where there is none (m).
  double innerRadius() const { return innerRadius_; }

  /// A bound on the coordinates of surface points, for bounds on rounding (m).
  double extent() const { return extent_; }

  /// Memory this volume holds, in bytes.
  std::size_t memory() const;

  /// Smallest big radius for these points and this margin (m); build() takes any R above it.
  /// @throws Error for points or a margin that build() refuses whatever the R.
  static double smallestR(const std::vector<Eigen::Vector3d>& points, double r);

  /// What this library's own queries read.
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
  int firstFace_ = 0;                         // the first face's patch
  std::shared_ptr<const detail::QueryTables> tables_;
  Eigen::Vector3d centre_{0, 0, 0};
  double enclosingRadius_ = 0, innerRadius_ = 0, extent_ = 0;
};

}  // namespace fcl_stpbv
