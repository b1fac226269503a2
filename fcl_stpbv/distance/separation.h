// The two searches that cannot fail: a plane between the cores, and the widest gap once there is one.
#pragma once

#include "fcl_stpbv/distance/ascent.h"

namespace fcl_stpbv {

/// What a search for a plane between the two cores found.
enum class CoreContact {
  apart,     ///< a normal with a positive gap between the cores
  touching,  ///< a common point, to rounding, and a normal with no overlap there
  overlap,   ///< no normal has one
};

/// Looks for a normal along which the cores are apart, from `x` on; leaves the best one in `x`.
///
/// Core points `y` of a trial normal `n` bound the gap everywhere: along `m` it is at most `m.(y_B - y_A)`.
/// So a trial that fails rules out half of all directions, its own included, and what is left is a convex
/// cone.
CoreContact separateCores(const BodyPair& pair, Sample& x, Work& work);

/// Finds the widest gap between cores that are apart along `x`, where `ascend` gave up. Normals with a wider
/// gap than at `n` lie where the gradient at `n` points (docs/theory.md, 5: the set is convex), so each trial
/// halves the cone.
bool bisectToWidest(const BodyPair& pair, Sample& x, Work& work);

}  // namespace fcl_stpbv
