// Bodies deeper in each other than their margins: the best separating translation among several local ones.
#pragma once

#include "fcl_stpbv/distance/ascent.h"

namespace fcl_stpbv {

/// Climbs from a fixed set of normals (both bodies' axes, diagonals and face normals, and the line of
/// centres) and leaves the best maximum in `x`. A function of the poses alone: nothing remembered enters, so
/// that the answer does not depend on the way the bodies came (paper II.C).
void leastPenetration(const BodyPair& pair, Sample& x, Work& work);

}  // namespace fcl_stpbv
