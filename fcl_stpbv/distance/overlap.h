// Penetration depth of two overlapping cores, with a bound that holds for every direction.
#pragma once

#include <array>

#include "fcl_stpbv/distance/ascent.h"

namespace fcl_stpbv::detail {

/// A starting normal for bodies that overlap deeply: the best of the line of centres and the normals of the
/// faces near either body's centre. A search from it likely ends at the global maximum. The sample is not
/// evaluated; its patches are near the owners of the normal.
Sample shallowStart(const BodyPair& pair);

/// A starting normal for long or flat bodies near each other: the axis along which their bounding boxes are
/// furthest apart or overlap least.
Sample boxStart(const BodyPair& pair);

/// EPA (van den Bergen 2001, "expanding polytope") on the difference of the two cores, starting around `x.n`.
/// Stores the maximum of the gap with the least overlap in `x`. Stores in `bound` an upper bound on the gap
/// of the cores along every normal (m, not positive). False if rounding, the size limit of the polytope or a
/// gap between the cores stopped it; `x` and `bound` are valid all the same.
bool expandPolytope(const BodyPair& pair, Sample& x, double& bound, SearchWork& work);

/// The same from four points of the difference around the origin.
bool expandPolytope(const BodyPair& pair, const std::array<Eigen::Vector3d, 4>& corner, Sample& x,
                    double& bound, SearchWork& work);

/// Climbs from a fixed set of normals (both bodies' axes, diagonals and face normals, and the line of
/// centres) and stores the best maximum in `x`. It uses no cache, so the result depends only on the poses,
/// not on earlier queries (paper II.C).
void leastPenetration(const BodyPair& pair, Sample& x, SearchWork& work);

}  // namespace fcl_stpbv::detail
