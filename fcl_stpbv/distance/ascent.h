// Monotone ascent of the gap over the sphere of normals, patch pair by patch pair.
#pragma once

#include "fcl_stpbv/distance/body_pair.h"

namespace fcl_stpbv {

/// What a query has done so far.
struct Work {
  int pairs = 0;  ///< patch pairs solved
  int steps = 0;  ///< patches changed
};

/// True when the widest normal of the sample's own patch pair stays in the regions of both: then it is a
/// maximum of the gap. On success `x` is moved there; otherwise `next` is that normal.
bool settle(const BodyPair& pair, Sample& x, Eigen::Vector3d& next, Work& work);

/// Settles on a patch pair near the sample's own: over the seam that the widest normal passes furthest, on either
/// body, to the next pair, without a look at the gap. A maximum that it finds between cores apart is the only
/// one; that it does not find one, as between overlapping cores, proves nothing.
bool hop(const BodyPair& pair, Sample& x, Work& work);

/// Like `settle`, of the patches across the seams that the way to the sample's own widest normal crosses: for
/// a maximum in a region so narrow (an edge's is its length over R wide) that the gap grows by less than its
/// rounding on the way there.
bool settleBeside(const BodyPair& pair, Sample& x, Work& work);

/// Climbs from `x` to a maximum of the gap; each step raises it. True when it got there. While the gap of the
/// cores is positive the maximum is the global one (docs/theory.md, 5).
bool ascend(const BodyPair& pair, Sample& x, Work& work);

}  // namespace fcl_stpbv
