// Monotone ascent of the gap over the sphere of normals, patch pair by patch pair.
#pragma once

#include "fcl_stpbv/distance/body_pair.h"

namespace fcl_stpbv::detail {

/// What a query has done so far.
struct SearchWork {
  int pairs = 0;  ///< patch pairs solved
  int steps = 0;  ///< patches changed
};

/// A normal that violates a boundary by at most this still counts as inside. The normal and the dot product
/// of the test both have rounding errors of 2e-16, and both patches agree there to second order.
constexpr double kOnBoundary = 1e-15;

/// True if the widest normal of the sample's patch pair is in the regions of both patches: then it is a
/// maximum of the gap. On success `x` is moved there; otherwise `next` is that normal.
bool settle(const BodyPair& pair, Sample& x, Eigen::Vector3d& next, SearchWork& work);

/// Like `settle`, but also tries the patches beyond the region boundaries between `x` and the widest normal
/// of its patch pair. This is for a maximum in a very narrow region (that of an edge is as wide as its length
/// over R), where the gap grows by less than its rounding on the way.
bool settleBeside(const BodyPair& pair, Sample& x, SearchWork& work);

/// Climbs from `x` to a maximum of the gap; each step raises the gap. True if it reached a maximum. While the
/// gap of the cores is positive, it is the global maximum (docs/theory.md, 5).
bool ascend(const BodyPair& pair, Sample& x, SearchWork& work);

/// Result of a search for a plane between the two cores.
enum class CoreContact {
  apart,     ///< a normal with a positive gap between the cores
  touching,  ///< a common point, to rounding, and a normal with no overlap there
  overlap,   ///< no normal has one
};

/// Searches a normal along which the cores are apart, starting from `x`; stores the best one in `x`.
///
/// The core points `y` of a trial normal `n` bound the gap along all directions: along `m` it is at most
/// `m.(y_B - y_A)`. So a trial without a gap excludes half of all directions, including its own. The
/// remaining directions form a convex cone.
CoreContact separateCores(const BodyPair& pair, Sample& x, SearchWork& work);

/// Finds the widest gap between cores that are apart along `x`, if `ascend` failed. All normals with a wider
/// gap than at `n` lie on the side to which the gradient at `n` points (docs/theory.md, 5: the set is
/// convex). So each trial halves the cone of candidates.
bool bisectToWidest(const BodyPair& pair, Sample& x, SearchWork& work);

}  // namespace fcl_stpbv::detail
