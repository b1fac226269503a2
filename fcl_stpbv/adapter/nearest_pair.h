// Finds the nearest two elements of two geometries, at least one of which is a mesh or an octree; and
// distance() for callers that ask about the same geometries again and again.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <array>
#include <cstdint>
#include <limits>

#include "fcl_stpbv/adapter/element_tree.h"
#include "fcl_stpbv/adapter/fcl_distance.h"

namespace fcl_stpbv::detail {

/// The distance, and the elements of meshes and octrees that have this distance.
struct ElementsDistance {
  Distance found;
  std::array<std::intptr_t, 2> element{-1, -1};  ///< triangles or cells, as FCL numbers them; -1 for a shape
  /// Distance of the second nearest pair of elements (m); for two surfaces only a lower bound on it.
  double runnerUp = std::numeric_limits<double>::infinity();
  int solved = 0;  ///< number of pairs of elements whose distance was computed, a measure of the work
  long looks = 0;  ///< for two meshes: number of pairs of boxes whose gap was computed
};

/// For a mesh or an octree against an STP-BV or a shape: the signed distance, the least over the elements.
/// For two meshes or octrees: 0 if they overlap, because surfaces have no depth, with the first two elements
/// found that meet and a common point; the status is `bounded` if it is not decided whether needle-shaped
/// elements meet. For an octree whose cells are all free: the largest double. `invalid` if a geometry is
/// empty, if a vertex is not finite (not checked with `finite`), or if a pose is not rigid. Allocates only
/// boxes that replace merged ones, unless `trees` has them. The cache is used for pairs with an STP-BV.
ElementsDistance nearestElements(const fcl::CollisionGeometryd& geometry1, const Eigen::Isometry3d& pose1,
                                 const fcl::CollisionGeometryd& geometry2, const Eigen::Isometry3d& pose2,
                                 bool finite, const KnownTrees& trees = {}, PairCache* cache = nullptr);

/// Like the public distance(), but reuses `trees`, which already contain the boxes that replace merged ones.
/// `context.finite` then only states that all vertices are finite.
DistanceAnswer distance(const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
                        const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2,
                        const QueryContext& context, const KnownTrees& trees);

}  // namespace fcl_stpbv::detail
