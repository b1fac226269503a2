// The gap of two STP-BVs along a normal. The owner of the normal on each body is found by a walk over patches
// from a hint; the gap is then one closed form (patch_pair.h).
#include "fcl_stpbv/distance/body_pair.h"

#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

FCL_STPBV_VECTORIZED
Sample BodyPair::sampleFrom(const Vector3d& n, const std::array<int, 2>& hint, int& steps) const {
  const std::array<int, 2> patch{a_.owner(n, hint[0]), b_.owner(opposite(n), hint[1])};
  steps += (hint[0] >= 0 && patch[0] != hint[0]) + (hint[1] >= 0 && patch[1] != hint[1]);
  return sample(n, patch);
}

}  // namespace fcl_stpbv::detail
