// The full search for the widest gap, for pairs in which the feature walk does not find it.
#pragma once

#include "fcl_stpbv/distance/ascent.h"
#include "fcl_stpbv/distance/distance.h"

namespace fcl_stpbv::detail {

/// The widest gap.
struct WidestGap {
  Sample at;
  DistanceStatus status = DistanceStatus::exact;
  double bound = 0.0;  ///< for cores that overlap: upper bound on the gap along every normal (m)
};

/// Where a search starts.
struct SearchStart {
  Eigen::Vector3d n;         ///< unit
  std::array<int, 2> patch;  ///< patches near the owners of `n`
  bool near;                 ///< whether the answer is likely to be near
};

/// Searches from the polyhedra's closest features, or, if the cores overlap, from corners around the origin.
/// If both fail because of rounding, it bisects the remaining normals. `settled`: `found.at` is already a
/// maximum between overlapping cores, but maybe not the global one.
void searchWidely(const BodyPair& pair, const SearchStart& start, bool settled, WidestGap& found,
                  SearchWork& work);

}  // namespace fcl_stpbv::detail
