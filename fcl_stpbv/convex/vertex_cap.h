// A cache that makes support points of polytopes with many vertices faster. A query needs about a dozen
// support points, most of them along similar normals. The cache keeps the few vertices that can be support
// points along such normals.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "fcl_stpbv/convex/shape.h"

namespace fcl_stpbv::detail {

/// Some of a polytope's vertices, one after the other in memory.
struct VertexList {
  const Eigen::Vector3d* first;
  int count;
};

/// The cache of one query for one polytope. Each call changes it, so threads must not share one.
class VertexCap {
 public:
  /// The vertex furthest along `d` (any length), up to rounding. All calls must be for the same polytope.
  Eigen::Vector3d furthest(const Eigen::Vector3d& d, const Eigen::Vector3d* vertices, int count);

  /// The vertices that can be furthest along unit vectors within the distance `chord` of the unit vector `n`:
  /// those of the cache if it knows all of them, otherwise all vertices.
  VertexList candidates(const Eigen::Vector3d& n, double chord, const Eigen::Vector3d* vertices,
                        int count) const;

 private:
  static constexpr int kRoom = 96;

  bool isNearAxis(const Eigen::Vector3d& d) const;

  // The last direction for which all vertices were searched, and its vertex.
  Eigen::Vector3d axis_{0, 0, 0}, furthest_;
  int count_ = 0;      // of `near_`; 0 until a second direction is near the first
  bool full_ = false;  // there are more near vertices than the array can store
  std::array<Eigen::Vector3d, kRoom> near_;
};

/// A copy of a shape for one query; a polytope with many vertices gets a VertexCap.
class QueriedShape {
 public:
  explicit QueriedShape(const Shape& shape) : shape_(shape) {
    if (shape.kind != ShapeKind::polytope || shape.vertexCount <= kMany || shape.cap) return;
    capped_ = shape;
    capped_->cap = &cap_;
  }
  QueriedShape(const QueriedShape&) = delete;

  const Shape& shape() const { return capped_ ? *capped_ : shape_; }

 private:
  static constexpr int kMany = 128;  // for fewer vertices visiting all of them is as fast
  const Shape& shape_;
  std::optional<Shape> capped_;
  VertexCap cap_;
};

}  // namespace fcl_stpbv::detail
