// The whole search for the widest gap, for pairs where the feature walk does not get there.
#pragma once

#include "fcl_stpbv/distance/ascent.h"
#include "fcl_stpbv/distance/distance.h"

namespace fcl_stpbv::detail {

/// The widest gap.
struct WidestGap {
  Sample at;
  DistanceStatus status = DistanceStatus::exact;
  double bound = 0.0;  ///< for cores that overlap: along no normal is their gap wider (m)
};

/// Where a search starts.
struct SearchStart {
  Eigen::Vector3d n;         ///< unit
  std::array<int, 2> patch;  ///< patches near those that own it
  bool near;                 ///< whether the answer is likely to be near
};

/// Searches from the polyhedra's closest features, from corners around the origin where the cores overlap,
/// or, where rounding defeats both, by cutting the normals left. `settled` says that `found.at` is a maximum
/// between cores that overlap; others may be wider.
void searchWidely(const BodyPair& pair, const SearchStart& start, bool settled, WidestGap& found,
                  SearchWork& work);

}  // namespace fcl_stpbv::detail
