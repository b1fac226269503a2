// Optimality certificate: proves that a local maximum of the gap between overlapping cores is the global one.
#pragma once

#include <cstddef>

#include "fcl_stpbv/convex/local_maximum.h"
#include "fcl_stpbv/distance/body_pair.h"

namespace fcl_stpbv::detail {

/// Up to four points of the difference of the two cores, second less first.
struct FeatureCorners {
  static constexpr std::size_t kMost = 4;
  Packed point[kMost];
  std::size_t count = 0;
};

/// The corners of the feature of the Minkowski difference that contains a maximum, counter-clockwise from
/// outside. The feature is a face against a vertex, or two edges that cross. For a face against more than a
/// vertex, the vertex nearest to the maximum is used. No corners for other features, which rarely contain the
/// global maximum.
FeatureCorners cornersAround(const BodyPair& pair, const Sample& top);

/// The maximum `top`, with the arcs and caps of the two cores around its points.
LocalMaximum localMaximum(const BodyPair& pair, const Sample& top);

/// Result of the proof, and the data for a search that continues from the maximum.
struct WidestProof {
  FeatureCorners corners;  ///< cornersAround
  LocalMaximum around;     ///< localMaximum
  /// The maximum is the global one: no normal has a gap of the cores above `bound` (m, negative).
  bool proven = false;
  double bound = 0;
};

/// Constructs a closed surface around the origin: from the maximum to the corners of its feature, and from
/// there over a ball inside the difference, or over the other sides of the difference of two boxes. The
/// surface lies in the difference of the cores, which is convex. So the depth is at least the distance of the
/// nearest plane of the surface. The maximum is proven if that plane is at the maximum and no wider gap is
/// possible beyond it.
///
/// The points only have to put the origin on the inner side of every triangle: then
/// each ray from the origin meets the surface.
WidestProof proveWidest(const BodyPair& pair, const Sample& top);

/// Closes a surface around the origin with the corners of a maximum's feature and a ball inside the
/// difference. It consists of the planes through each side of the feature that touch the ball, the cones from
/// each corner that touch the ball, and the ball itself behind them. True if every plane of it is at least
/// `depth` from the origin; then only the feature itself is left to check. For round bodies this is enough,
/// and it does not visit their vertices (docs/theory.md, 5).
///
/// `centre` and `corners`, counter-clockwise from outside, are relative to the origin, `n` is the maximum's
/// normal, away from which the feature lies (m).
bool closesOverBall(const Packed& centre, double radius, const FeatureCorners& corners, const Packed& n,
                    double depth);

}  // namespace fcl_stpbv::detail
