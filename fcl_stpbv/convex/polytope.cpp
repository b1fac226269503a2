// The two inner steps of a growing polytope, compiled also for wider vector instructions (vectorized.h).
#include "fcl_stpbv/convex/polytope.h"

#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {

FCL_STPBV_VECTORIZED
Polytope::Face WidePolytope::nearest() { return Polytope::nearest(); }

FCL_STPBV_VECTORIZED
bool WidePolytope::expand(const Eigen::Vector3d& outside, const Eigen::Vector3d& part) {
  return Polytope::expand(outside, part);
}

}  // namespace fcl_stpbv::detail
