// The directions that may still hold the answer: a convex cone, cut down plane by plane.
#pragma once

#include <Eigen/Core>
#include <array>

namespace fcl_stpbv {

/// A convex cone of directions, kept as its corner rays in order. Every cut through its middle takes about
/// half of it, so a search that cuts at each trial ends whatever the bodies look like.
class NormalCone {
 public:
  static constexpr int kMaxCuts = 200;  ///< halving a hemisphere down to rounding takes about 110

  /// All directions `m` with `m.pole > 0`, but for a rim of 1e-8 rad.
  explicit NormalCone(const Eigen::Vector3d& pole);

  /// Keeps the directions with `m.g >= 0`. False when none is left.
  bool cut(const Eigen::Vector3d& g);

  /// A unit direction well inside.
  Eigen::Vector3d middle() const;

 private:
  std::array<Eigen::Vector3d, kMaxCuts + 4> corner_;
  int count_ = 4;
};

}  // namespace fcl_stpbv
