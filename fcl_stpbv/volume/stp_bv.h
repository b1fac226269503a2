// The sphere-torus-patch bounding volume: what it is and what can be asked of it.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/volume/patch_table.h"
#include "fcl_stpbv/volume/vertex_star.h"

namespace fcl_stpbv {

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
  using Ptr = std::shared_ptr<const StpBv>;
  using Ring = std::vector<int>;  ///< a face's vertices, counter-clockwise seen from outside

  /// An edge's two vertices and the faces on its two sides; faces are -1 on a spindle (two vertices, one edge
  /// patch all the way round). `face[0]` runs from `vertex[0]` to `vertex[1]`; `turn` is the angle about the
  /// edge from its normals to those of `face[1]`, below 2 pi, and 2 pi on a spindle. Two vertices may be
  /// joined by several edges.
  struct Edge {
    std::array<int, 2> vertex;
    std::array<int, 2> face;
    double turn;
  };

  /// Rolls a ball of radius `R - r` over the cloud (paper IV.A, Algorithm 1). Points that it cannot touch are
  /// inside and drop out; cospherical ones share one k-gon face.
  /// @throws Error for an empty cloud, a coordinate that is not finite, r < 0, R <= r, or R below the
  /// smallest
  ///   usable one, which the message states.
  static Ptr build(const std::vector<Eigen::Vector3d>& points, const StpBvOptions& options = {});

  /// Puts a volume together from its own vertices and faces, as a file holds them.
  /// @throws Error where they are not an STP-BV's for these radii: an index out of range, faces that do not
  /// close, or a
  ///   vertex outside a face's ball.
  static Ptr assemble(std::vector<Eigen::Vector3d> vertices, std::vector<Ring> faces,
                      const StpBvOptions& options);

  const Radii& radii() const { return radii_; }
  const std::vector<Eigen::Vector3d>& vertices() const { return vertices_; }
  const std::vector<Edge>& edges() const { return edges_; }
  const std::vector<Ring>& faces() const { return faces_; }

  /// Unit outward normal of a face's big sphere at one of the face's vertices: a corner where regions meet.
  Eigen::Vector3d corner(int face, int vertex) const;

  int vertexCount() const { return static_cast<int>(vertices_.size()); }
  int edgeCount() const { return static_cast<int>(edges_.size()); }
  int faceCount() const { return static_cast<int>(faces_.size()); }

  /// Patches are numbered vertices first, then edges, then the further parts of edges that turn by more than
  /// half a turn, then faces: each patch's region of normals is the intersection of its boundaries' sides.
  int patchCount() const { return patches_.count(); }
  int edgePatch(int edge) const { return patches_.firstEdge() + edge; }
  int facePatch(int face) const { return patches_.firstFace() + face; }
  PatchKind kind(int patch) const { return patches_.kind(patch); }
  Patch patch(int index) const { return patches_.patch(index); }
  const PatchTable& patches() const { return patches_; }

  /// The boundaries around a patch's region of normals (paper III.D).
  PatchTable::Boundaries boundaries(int patch) const { return patches_.boundaries(patch); }

  /// Rounding of a rise along `d`, of the sum of its components.
  static constexpr float kLevel = 1e-6f;

  /// The vertex itself, or its neighbour up the steepest edge along `d`. Edges that rise by less than `level`
  /// a metre, `kLevel` of the sum of the components of `d` for rounding, count as level.
  int uphill(int vertex, const Eigen::Vector3f& d, float level) const {
    const VertexStar* star = &stars_[static_cast<std::size_t>(vertex)];
    std::int32_t best = star->steepest(d), enough;
    std::memcpy(&enough, &level, sizeof level);
    int over = star->neighbour[best & (VertexStar::kSize - 1)];
    while (star->next >= 0) {
      star = &stars_[static_cast<std::size_t>(star->next)];
      const std::int32_t other = star->steepest(d);
      if (other > best) best = other, over = star->neighbour[other & (VertexStar::kSize - 1)];
    }
    return best > enough ? over : vertex;
  }

  /// A neighbour of the vertex, itself highest along `d`, that is least below it. `length` is at least that
  /// of `d`.
  int beside(int vertex, const Eigen::Vector3f& d, float length) const {
    const VertexStar& star = stars_[static_cast<std::size_t>(vertex)];
    return star.neighbour[star.steepest(d, 2.0f * length) & (VertexStar::kSize - 1)];
  }

  /// How far the unit normal `n` lies outside the patch's region, <= 0 inside.
  double outside(int patch, const Eigen::Vector3d& n) const { return patches_.crossing(patch, pack(n)).past; }

  /// A vertex about as far along `n`, of any length, as any, from a direction table.
  int vertexNear(const Eigen::Vector3d& n) const { return vertexTable_[cell(n)]; }

  /// The patch whose region holds the unit normal `n`, found by walking over the boundaries from `hint` (any
  /// patch), or from a direction table when `hint` is negative.
  int owner(const Eigen::Vector3d& n, int hint = -1) const;

  /// Support function h(n) = max over the body of x.n, for unit `n` (m).
  double support(const Eigen::Vector3d& n, int hint = -1) const;

  /// The surface point whose outward normal is the unit vector `n` (m).
  Eigen::Vector3d surfacePoint(const Eigen::Vector3d& n, int hint = -1) const;

  /// A point well inside, the centre of the vertices' minimum enclosing ball, and that ball's radius (m):
  /// every surface point is within `enclosingRadius()` of `centre()`.
  const Eigen::Vector3d& centre() const { return centre_; }
  double enclosingRadius() const { return enclosingRadius_; }

  /// Radius of a ball about `centre()` inside the vertices' hull, 0 where there is none (m).
  double innerRadius() const { return innerRadius_; }

  /// A bound on the coordinates of surface points, for bounds on rounding (m).
  double extent() const { return extent_; }

  /// Memory this volume holds, in bytes.
  std::size_t memory() const;

  /// Smallest big radius for these points and this margin (m); build() takes any R above it.
  static double smallestR(const std::vector<Eigen::Vector3d>& points, double r);

 private:
  StpBv() = default;
  static Ptr make(std::vector<Eigen::Vector3d> vertices, std::vector<Ring> faces,
                  const StpBvOptions& options);
  void makeEdges();
  void makeInnerRadius();
  void makePatches();
  void makeStars();
  void makeTable();

  /// The vertex furthest along `d` to single precision, from `vertex` on.
  int climb(int vertex, const Eigen::Vector3f& d) const {
    const float level = kLevel * d.lpNorm<1>();
    for (int over, step = vertexCount(); step > 0 && (over = uphill(vertex, d, level)) != vertex; --step)
      vertex = over;
    return vertex;
  }

  /// The cell of a direction, not zero: the sphere as an octahedron, whose lower half is folded out to a
  /// square.
  std::size_t cell(const Eigen::Vector3d& n) const {
    const double half = 0.5 * cells_, scale = half / n.lpNorm<1>();
    const double x = n.x() * scale, y = n.y() * scale;
    const double folded = n.z() < 0.0 ? 1.0 : 0.0;  // as a factor: the branch would be mispredicted
    const double u = x + folded * (std::copysign(half - std::abs(y), x) - x);
    const double v = y + folded * (std::copysign(half - std::abs(x), y) - y);
    const auto slot = [&](double along) { return std::clamp(static_cast<int>(along + half), 0, cells_ - 1); };
    return static_cast<std::size_t>(slot(u) * cells_ + slot(v));
  }

  Radii radii_{};
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Edge> edges_;
  std::vector<Ring> faces_;
  std::vector<Eigen::Vector3d> faceNormals_;  // unit, at each ring's first vertex
  PatchTable patches_;
  std::vector<VertexStar> stars_;          // one a vertex, then the further ones
  std::vector<std::int32_t> table_;        // patch owning the middle of each cell of a map of directions
  std::vector<std::int32_t> vertexTable_;  // vertex furthest along the middle of each such cell
  int cells_ = 1;                          // cells along a side of the map
  Eigen::Vector3d centre_{0, 0, 0};
  double enclosingRadius_ = 0, innerRadius_ = 0, extent_ = 0;
};

}  // namespace fcl_stpbv
