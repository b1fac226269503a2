// The convex hull of a volume's vertices as a graph for hill climbing. It is the polyhedron that FCL gets.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/direction_table.h"
#include "fcl_stpbv/volume/rolling_ball.h"
#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv::detail {

/// A feature of the convex hull: a vertex, edge or face, by its index in the hull.
struct HullFeature {
  PatchKind kind = PatchKind::vertex;
  int index = -1;  ///< -1: none
};

/// Convex hull of a cloud: strictly extreme vertices only, coplanar faces merged. Immutable.
///
/// Hill climbing needs a hull of this kind: with a vertex inside a flat face it could stop at the wrong
/// vertex. Points are stored relative to `centre()`, so that a cloud far from the origin of its frame keeps
/// its accuracy.
class HullGraph {
 public:
  using Ring = std::vector<int>;

  /// @throws Error for a cloud that is empty or not finite.
  explicit HullGraph(const std::vector<Eigen::Vector3d>& cloud);

  /// The same from the cloud and the result of convexHull() for it.
  HullGraph(const std::vector<Eigen::Vector3d>& cloud, RolledHull hull);

  int vertexCount() const { return static_cast<int>(points_.size()); }
  int edgeCount() const { return static_cast<int>(edges_.size()); }
  int faceCount() const { return static_cast<int>(faces_.size()); }

  /// Vertex `v` relative to `centre()` (m).
  const Eigen::Vector3d& point(int v) const { return points_[at(v)]; }
  /// Centre of the points' bounding box, and the distance of the farthest vertex from it (m).
  const Eigen::Vector3d& centre() const { return centre_; }
  double radius() const { return radius_; }
  /// Index of vertex `v` in the cloud.
  int cloudIndex(int v) const { return cloudIndex_[at(v)]; }

  const std::vector<std::array<int, 2>>& edges() const { return edges_; }
  const std::vector<Ring>& faces() const { return faces_; }
  const std::vector<std::array<int, 2>>& edgeFaces() const { return edgeFaces_; }  ///< -1 on a bare segment
  /// Unit outward normal of a face.
  const Eigen::Vector3d& faceNormal(int f) const { return normals_[at(f)]; }

  /// Vertices joined to `v` by an edge.
  const std::int32_t* neighboursBegin(int v) const { return neighbours_.data() + start_[at(v)]; }
  const std::int32_t* neighboursEnd(int v) const {
    return neighbours_.data() + start_[static_cast<std::size_t>(v) + 1];
  }

  /// The vertex farthest along `direction` (any length). Climbs from the vertex `from`, or, if `from` is
  /// negative, from a vertex of a direction table. Does not allocate.
  int extremeVertex(const Eigen::Vector3d& direction, int from) const;

  /// The smallest feature that contains all the given vertices (one to three, distinct); a single vertex if
  /// there is no such feature.
  HullFeature featureOf(const int* vertices, int count) const;

 private:
  /// Eight vertices, whose heights along a direction are computed at once. A short chunk repeats its first
  /// vertex.
  struct Chunk {
    using Eight = Eigen::Array<double, 8, 1, Eigen::DontAlign>;
    Eight x, y, z;
    std::array<std::int32_t, 8> vertex;
  };

  void makeEdges();
  void makeChunks();
  void makeTable();
  void addChunks(const std::int32_t* begin, const std::int32_t* end);
  bool higherIn(std::int32_t firstChunk, std::int32_t lastChunk, const Eigen::Vector3d& direction,
                double& height, int& vertex) const;
  int climb(const Eigen::Vector3d& direction, int from) const;

  Eigen::Vector3d centre_{0, 0, 0};
  double radius_ = 0;
  std::vector<Eigen::Vector3d> points_;
  std::vector<int> cloudIndex_;
  std::vector<Ring> faces_;
  std::vector<Eigen::Vector3d> normals_;
  std::vector<std::array<int, 2>> edges_, edgeFaces_;
  std::vector<std::int32_t> start_, neighbours_, neighbourEdges_;  // by vertex
  std::vector<std::int32_t> faceStart_, vertexFaces_;              // faces around each vertex, ascending
  std::vector<Chunk> chunks_;             // all vertices of a small hull, else the neighbours of each vertex
  std::vector<std::int32_t> chunkStart_;  // by vertex
  DirectionTable table_;                  // extreme vertex for the middle of each cell
};

}  // namespace fcl_stpbv::detail
