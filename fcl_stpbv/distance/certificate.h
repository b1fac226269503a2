// Whether a maximum of the gap between overlapping cores is the widest one: an optimality certificate.
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

/// The corners, counter-clockwise from outside, of the difference's feature that a maximum is on: of a face
/// against a vertex, or of two edges that cross. Of a face against more than a vertex those against the
/// vertex nearest to the maximum. None of other features, which are rarely one.
FeatureCorners cornersAround(const BodyPair& pair, const Sample& top);

/// The maximum `top`, and what the two cores hold around its points.
LocalMaximum localMaximum(const BodyPair& pair, const Sample& top);

/// Whether a maximum is the widest gap, and what a search needs that goes on from it.
struct WidestProof {
  FeatureCorners corners;  ///< cornersAround
  LocalMaximum around;     ///< localMaximum
  bool proven = false;     ///< along no normal is the gap of the cores more than `bound` (m, negative)
  double bound = 0;
};

/// Closes a surface around the origin: from the maximum to the corners of its feature, and from
/// there over a ball inside, or over the other sides of two boxes' difference.
/// All of it lies in the difference of the cores, which is convex, so no direction leads out of it sooner
/// than through the nearest plane. Proven where that is one at the top and hides no wider gap.
///
/// The points only have to put the origin on the inner side of every triangle: then
/// each ray from the origin meets the surface.
WidestProof proveWidest(const BodyPair& pair, const Sample& top);

/// Closes a surface around the origin from the corners of a maximum's feature over a ball that the difference
/// holds: from each side of the feature along the plane that touches the ball, from each corner along the
/// cone that does, and over the ball behind. True where every plane of it is at least `depth` from the
/// origin; what is missing then is the feature alone. Round bodies, however many vertices they have, need no
/// more, and none of their vertices is looked at (docs/theory.md, 5).
///
/// `centre` and `corners`, counter-clockwise from outside, are relative to the origin, `n` is the maximum's
/// normal, away from which the feature lies (m).
bool closesOverBall(const Packed& centre, double radius, const FeatureCorners& corners, const Packed& n,
                    double depth);

}  // namespace fcl_stpbv::detail
