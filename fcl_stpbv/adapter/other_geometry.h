// An STP-BV against any other FCL geometry: simple shapes, meshes and trees.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <cstdint>
#include <limits>

#include "fcl_stpbv/adapter/element_tree.h"
#include "fcl_stpbv/distance/distance.h"

namespace fcl_stpbv::detail {

/// The distance, and what of a mesh or a tree it is to.
struct OtherDistance {
  Distance found;              ///< body 1 is the STP-BV
  std::intptr_t element = -1;  ///< triangle or cell, as FCL numbers them; -1 for simple shapes
  double runnerUp = std::numeric_limits<double>::infinity();  ///< distance to the next element (m)
  bool continuous = true;  ///< the gradient too: false for meshes and trees, whose nearest element switches
};

/// Solves the pair. `invalid` where this library has no answer: a type it does not know, nothing to measure
/// to, or a corner that is no number, unless the caller knows that all are (`finite`). Allocates nothing but
/// boxes in place of those that FCL has merged, unless the `tree` has them.
OtherDistance distanceToOther(const StpBv& volume, const Eigen::Isometry3d& poseVolume,
                              const fcl::CollisionGeometryd& other, const Eigen::Isometry3d& poseOther,
                              PairCache* cache, bool finite, const ElementTree* tree = nullptr);

}  // namespace fcl_stpbv::detail
