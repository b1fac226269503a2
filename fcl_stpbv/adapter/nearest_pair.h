// Two geometries, one of them at least a mesh or a tree: their nearest two elements.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <array>
#include <cstdint>
#include <limits>

#include "fcl_stpbv/adapter/element_tree.h"
#include "fcl_stpbv/distance/distance.h"

namespace fcl_stpbv::detail {

/// The distance, and what of meshes and trees it is between.
struct ElementsDistance {
  Distance found;
  std::array<std::intptr_t, 2> element{-1, -1};  ///< triangles or cells, as FCL numbers them; -1 for a shape
  /// Distance of the next two elements; of two surfaces no more than that (m).
  double runnerUp = std::numeric_limits<double>::infinity();
  int solved = 0;  ///< pairs of elements whose distance was asked: the work
  long looks = 0;  ///< two meshes: pairs of boxes whose gap was asked
};

/// A mesh or a tree against an STP-BV or a shape: signed, the least over its elements. Two of them: 0 where
/// they overlap, for surfaces have no depth, with the first two elements found to meet and a point of both;
/// `bounded` where it is open whether needles meet. Of a tree whose cells are all free the largest double.
/// `invalid` where either has nothing in it or a corner that is no number, unless the caller knows that all
/// are (`finite`), or a pose is not rigid. Allocates nothing but boxes in place of those that FCL has merged,
/// unless `trees` has them. The cache serves pairs with an STP-BV.
ElementsDistance nearestElements(const fcl::CollisionGeometryd& geometry1, const Eigen::Isometry3d& pose1,
                                 const fcl::CollisionGeometryd& geometry2, const Eigen::Isometry3d& pose2,
                                 bool finite, const KnownTrees& trees = {}, PairCache* cache = nullptr);

}  // namespace fcl_stpbv::detail
