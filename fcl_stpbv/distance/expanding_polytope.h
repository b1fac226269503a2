// How deep two overlapping cores are in each other, with a bound that holds for every direction.
#pragma once

#include <array>

#include "fcl_stpbv/distance/ascent.h"

namespace fcl_stpbv {

/// Grows a polytope inside the difference of the two cores, out from four of its points around the origin,
/// where its surface is nearest (van den Bergen 2001, "expanding polytope"). Leaves the normal with the least
/// overlap seen in `x` and returns a bound: along no normal is the gap of the cores more than this (m, not
/// positive). False when rounding or the size of the polytope stopped it; `x` and the bound hold all the
/// same.
bool expandPolytope(const BodyPair& pair, const std::array<Eigen::Vector3d, 4>& corner, Sample& x,
                    double& bound, Work& work);

}  // namespace fcl_stpbv
