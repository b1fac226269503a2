// How deep two overlapping cores are in each other, with a bound that holds for every direction.
#pragma once

#include <array>

#include "fcl_stpbv/distance/ascent.h"

namespace fcl_stpbv {

/// Grows a polytope inside the difference of the two cores where its surface is nearest to the origin (van
/// den Bergen 2001, "expanding polytope"), from around `x.n`. Leaves the maximum of the gap with the least
/// overlap in `x`, and in `bound` what holds for all: along no normal is the gap of the cores more than this
/// (m, not positive). False when rounding, the size of the polytope or a gap between the cores stopped it;
/// `x` and the bound hold all the same.
bool expandPolytope(const BodyPair& pair, Sample& x, double& bound, Work& work);

/// The same from four points of the difference around the origin.
bool expandPolytope(const BodyPair& pair, const std::array<Eigen::Vector3d, 4>& corner, Sample& x,
                    double& bound, Work& work);

}  // namespace fcl_stpbv
