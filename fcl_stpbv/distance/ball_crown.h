// A ball inside the difference of two cores, as a proof that no direction leads out sooner than a maximum's.
#pragma once

#include "fcl_stpbv/distance/crown.h"

namespace fcl_stpbv {

/// Closes a surface around the origin from the corners of a maximum's feature over a ball that the difference
/// holds: from each side of the feature along the plane that touches the ball, from each corner along the
/// cone that does, and over the ball behind. True where every plane of it is at least `depth` from the
/// origin; what is missing then is the feature alone. Round bodies, however many vertices they have, need no
/// more, and none of their vertices is looked at (docs/theory.md, 5).
///
/// `centre` and `corners`, counter-clockwise from outside, are relative to the origin, `n` is the maximum's
/// normal, away from which the feature lies (m).
bool ballCloses(const Packed& centre, double radius, const Corners& corners, const Packed& n, double depth);

}  // namespace fcl_stpbv
