// Monotone ascent of the gap over the sphere of normals, patch pair by patch pair.
#pragma once

#include "fcl_stpbv/distance/body_pair.h"

namespace fcl_stpbv::detail {

/// What a query has done so far.
struct SearchWork {
  int pairs = 0;  ///< patch pairs solved
  int steps = 0;  ///< patches changed
};

/// A normal this far past a boundary still counts as inside: it is rounded to 2e-16 itself, as is the dot
/// product that tells, and both patches agree there to the second order.
constexpr double kOnBoundary = 1e-15;

/// True when the widest normal of the sample's own patch pair stays in the regions of both: then it is a
/// maximum of the gap. On success `x` is moved there; otherwise `next` is that normal.
bool settle(const BodyPair& pair, Sample& x, Eigen::Vector3d& next, SearchWork& work);

/// Like `settle`, of the patches across the region boundaries that the way to the sample's own widest normal
/// crosses: for a maximum in a region so narrow (an edge's is its length over R wide) that the gap grows by
/// less than its rounding on the way there.
bool settleBeside(const BodyPair& pair, Sample& x, SearchWork& work);

/// Climbs from `x` to a maximum of the gap; each step raises it. True when it got there. While the gap of the
/// cores is positive the maximum is the global one (docs/theory.md, 5).
bool ascend(const BodyPair& pair, Sample& x, SearchWork& work);

/// What a search for a plane between the two cores found.
enum class CoreContact {
  apart,     ///< a normal with a positive gap between the cores
  touching,  ///< a common point, to rounding, and a normal with no overlap there
  overlap,   ///< no normal has one
};

/// Looks for a normal along which the cores are apart, from `x` on; leaves the best one in `x`.
///
/// Core points `y` of a trial normal `n` bound the gap everywhere: along `m` it is at most
/// `m.(y_B - y_A)`. So a trial that fails rules out half of all directions, its own
/// included, and what is left is a convex cone.
CoreContact separateCores(const BodyPair& pair, Sample& x, SearchWork& work);

/// Finds the widest gap between cores that are apart along `x`, where `ascend` gave up. Normals
/// with a wider gap than at `n` lie where the gradient at `n` points (docs/theory.md, 5: the set
/// is convex), so each trial halves the cone.
bool bisectToWidest(const BodyPair& pair, Sample& x, SearchWork& work);

}  // namespace fcl_stpbv::detail
