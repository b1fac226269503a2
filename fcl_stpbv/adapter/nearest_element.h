// The nearest of many elements, triangles or cells: what a walk down FCL's hierarchies keeps.
#pragma once

#include <cstdint>
#include <limits>

#include "fcl_stpbv/distance/shape_distance.h"

namespace fcl_stpbv {

/// A box anywhere in the frame of a mesh or a tree, as every FCL bounding volume has one around it.
struct OrientedBox {
  Eigen::Vector3d centre;
  Eigen::Matrix3d axes;  ///< columns
  Eigen::Vector3d half;  ///< half sides (m)
};

/// One STP-BV against the elements of one mesh or tree. Lives on the stack of one query.
class NearestElement {
 public:
  NearestElement(const StpBv& volume, const Eigen::Isometry3d& poseVolume,
                 const Eigen::Isometry3d& poseElements, PairCache* cache);

  /// A lower bound of the volume's distance to anything in `box` (m): by the volume's enclosing ball, and by
  /// the gap along the best normal so far (docs/theory.md, 5: any normal gives one).
  double lowerBound(const OrientedBox& box) const;

  /// Whether something in `box` may be nearer than what is known. What is not is kept for `runnerUp`.
  bool mayImprove(double bound);

  /// Solves an element and keeps the nearest.
  void offer(const Shape& element, const Eigen::Isometry3d& pose, std::intptr_t id);

  bool any() const { return any_; }
  const Distance& best() const { return best_; }
  std::intptr_t element() const { return element_; }
  /// No element but the nearest is nearer than this (m).
  double runnerUp() const { return runnerUp_; }
  const Eigen::Isometry3d& pose() const { return poseElements_; }

 private:
  const StpBv& volume_;
  Eigen::Isometry3d poseVolume_, poseElements_;
  Eigen::Matrix3d rotation_;              // elements' frame to the volume's
  Eigen::Vector3d translation_, centre_;  // centre of the volume, in the elements' frame
  Eigen::Vector3d n_{0, 0, 0};            // best normal, in the elements' frame
  double support_ = 0;                    // the volume's along it, measured from centre_
  PairCache* cache_;
  Distance best_;
  bool any_ = false;
  std::intptr_t element_ = -1;  // a tree's ids may be negative
  double runnerUp_ = std::numeric_limits<double>::infinity();
};

}  // namespace fcl_stpbv
