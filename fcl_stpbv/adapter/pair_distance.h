// One pair of geometries asked again and again.
#pragma once

#include <memory>
#include <utility>

#include "fcl_stpbv/adapter/fcl_distance.h"

namespace fcl_stpbv {

/// Distance of a fixed pair of geometries over many poses; each query starts from the last answer. One thread
/// at a time may use one; any number of them may share geometries.
class PairDistance {
 public:
  using Geometry = std::shared_ptr<const fcl::CollisionGeometryd>;  ///< shared with whoever else uses it

  /// `mapping`, optional, gets how good FCL's features were as starts, and
  /// makes the queries that ask FCL slower.
  PairDistance(Geometry geometry1, Geometry geometry2, MappingCounts* mapping = nullptr)
      : geometry1_(std::move(geometry1)), geometry2_(std::move(geometry2)), mapping_(mapping) {}

  /// The distance at these poses, as distance() answers it (fcl_distance.h).
  DistanceAnswer operator()(const fcl::Transform3d& pose1, const fcl::Transform3d& pose2) {
    return distance(*geometry1_, pose1, *geometry2_, pose2, {&cache_, mapping_});
  }

  /// Makes the next query start as the first one did.
  void forget() { cache_ = {}; }

 private:
  Geometry geometry1_, geometry2_;
  PairCache cache_;
  MappingCounts* mapping_;
};

}  // namespace fcl_stpbv
