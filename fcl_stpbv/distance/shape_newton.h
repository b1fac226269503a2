// The normal of two shapes' distance to rounding, by Newton's method on the features that face each other.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/convex/shape.h"

namespace fcl_stpbv::detail {

/// Two points of the cores that are opposite each other along a normal. Frame of the first shape.
struct OppositePoints {
  Eigen::Vector3d n{0, 0, 1};  ///< unit, from the first shape to the second
  double gap =
      -std::numeric_limits<double>::infinity();  ///< between the cores' supporting planes along it (m)
  Eigen::Vector3d onA{0, 0, 0};                  ///< the first core's point
  Eigen::Vector3d toB{0, 0, 0};  ///< from there to the second core's, `gap` along `n` to rounding
};

/// Where the gap of two bounded shapes' cores is widest, the nearest points of cores that are apart, from
/// what a search ended with: a normal `n` not further than `angle` (rad) from the answer's, its gap, and a
/// point `onA` of the first core next to the answer's. What is within `rounding` (m) counts as equal. Nothing
/// where the features next to `n` do not hold an answer of at least that gap.
std::optional<OppositePoints> nearestOnFeatures(const Shape& a, const Shape& b, const RelativePose& pose,
                                                const Eigen::Vector3d& n, double gap,
                                                const Eigen::Vector3d& onA, double angle, double rounding);

}  // namespace fcl_stpbv::detail
