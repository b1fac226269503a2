// The nearest of many elements, triangles or cells, and the one after it.
#pragma once

#include "fcl_stpbv/adapter/element_tree.h"
#include "fcl_stpbv/distance/shape_distance.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

/// One STP-BV against the elements of one mesh or tree: a walk down the hierarchy, near branches first, that
/// leaves out what cannot be one of the nearest two. Lives on the stack of one query.
class NearestElement {
 public:
  NearestElement(const StpBv& volume, const Eigen::Isometry3d& poseVolume, const ElementTree& elements,
                 const Eigen::Isometry3d& poseElements, PairCache* cache);

  /// Whether there is an answer: an element, and none that is no body among those looked at.
  bool any() const { return any_ && !broken_; }
  /// The nearest, with bounds of the least of all: a depth that is not exact may be the lowest, whatever it
  /// says itself.
  Distance best() const;
  std::intptr_t element() const { return element_; }
  /// Distance to the second nearest element (m); infinite if there is but one.
  double runnerUp() const { return runnerUp_; }

 private:
  void visit(const ElementTree::Node& node, double bound);
  void offer(const Shape& element, const Eigen::Vector3d& place, std::intptr_t id);
  void takeBounds(const Distance& found, double rounding);
  /// A lower bound of the distance to anything in `box` (m): by the volume's enclosing ball, and by the gap
  /// along the best normal so far (docs/theory.md, 5: any normal gives one).
  double lowerBound(const OrientedBox& box) const;
  double lowerBound(const Shape& element, const Eigen::Vector3d& place) const;

  const StpBv& volume_;
  const ElementTree& elements_;
  Eigen::Isometry3d poseVolume_, poseElements_;
  Eigen::Matrix3d rotation_;              // elements' frame to the volume's
  Eigen::Vector3d translation_, centre_;  // centre of the volume, in the elements' frame
  Eigen::Vector3d n_{0, 0, 0};            // best normal, in the elements' frame
  double support_ = 0;                    // the volume's along it, measured from centre_
  PairCache* cache_;
  Distance best_;
  double lower_ = kInfinity, upper_ = kInfinity;
  bool exact_ = true;  // whether the answer that the lower bound comes from is
  bool any_ = false, broken_ = false;
  std::intptr_t element_ = -1;  // a tree's ids may be negative
  double runnerUp_ = kInfinity;
};

}  // namespace fcl_stpbv::detail
