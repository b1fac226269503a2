// Computes the normal of two shapes' distance up to rounding, by Newton's method on the two nearest features.
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

/// What a search knows about the widest gap between two cores. Frame of the first shape.
struct NearNormal {
  Eigen::Vector3d n;    ///< unit, from the first shape to the second
  double gap;           ///< along it (m)
  Eigen::Vector3d onA;  ///< a point of the first core near the answer's
  double angle;         ///< error of `n` (rad)
  /// The answer's features probably reach from the support points along `n` down to these heights (m); not
  /// used if negative.
  double featureA = -1.0, featureB = -1.0;
};

/// The widest gap between the cores of two bounded shapes, with the two points; for cores apart these are the
/// nearest points. Lengths within `rounding` (m) count as equal. No value if the features near the known
/// normal do not contain an answer with at least its gap.
std::optional<OppositePoints> nearestOnFeatures(const Shape& a, const Shape& b, const RelativePose& pose,
                                                const NearNormal& known, double rounding);

}  // namespace fcl_stpbv::detail
