// How deep two overlapping cores are in each other, with a bound that holds for every direction.
#pragma once

#include <array>

#include "fcl_stpbv/distance/ascent.h"

namespace fcl_stpbv::detail {

/// For bodies deep in each other: the widest gap along the line of centres and the normals of the faces near
/// either body's centre, from where a search for the widest of all is likely to end there. Not evaluated; the
/// patches are near those that own it.
Sample shallowStart(const BodyPair& pair);

/// For long or flat bodies near each other: the axis along which the boxes around
/// them are furthest apart or overlap least.
Sample boxStart(const BodyPair& pair);

/// Grows a polytope inside the difference of the two cores where its surface is nearest to the origin (van
/// den Bergen 2001, "expanding polytope"), from around `x.n`. Leaves the maximum of the gap with the least
/// overlap in `x`, and in `bound` what holds for all: along no normal is the gap of the cores more than this
/// (m, not positive). False when rounding, the size of the polytope or a gap between the cores stopped it;
/// `x` and the bound hold all the same.
bool expandPolytope(const BodyPair& pair, Sample& x, double& bound, SearchWork& work);

/// The same from four points of the difference around the origin.
bool expandPolytope(const BodyPair& pair, const std::array<Eigen::Vector3d, 4>& corner, Sample& x,
                    double& bound, SearchWork& work);

/// Climbs from a fixed set of normals (both bodies' axes, diagonals and face normals, and the line of
/// centres) and leaves the best maximum in `x`. A function of the poses alone: nothing remembered enters, so
/// that the answer does not depend on the way the bodies came (paper II.C).
void leastPenetration(const BodyPair& pair, Sample& x, SearchWork& work);

}  // namespace fcl_stpbv::detail
