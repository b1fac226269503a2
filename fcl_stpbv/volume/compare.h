// How far apart two volumes are that should be equal.
#pragma once

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {

/// Largest distance between the two surfaces' tangent planes of the same normal, over the
/// normals of all faces' corners and a thousand more all around (m): from below, how far
/// the bodies are apart in Hausdorff's sense.
double surfaceDifference(const StpBv& a, const StpBv& b);

/// How many vertices of `a` have none of `b` within `radius` (m).
int withoutPartner(const StpBv& a, const StpBv& b, double radius);

}  // namespace fcl_stpbv
