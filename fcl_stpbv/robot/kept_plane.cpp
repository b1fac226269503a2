// The stored directions turn with the bodies. When they were stored, they were opposite. The length of their
// sum now bounds how much the gap has shrunk.
#include "fcl_stpbv/robot/kept_plane.h"

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {

using Eigen::Isometry3d;

FCL_STPBV_VECTORIZED
double turnSince(const KeptPlane& plane, const Isometry3d& frameA, const Isometry3d& frameB) {
  const Packed t = turned(frameA, plane.outward[0]) + turned(frameB, plane.outward[1]);
  return dot(t, t);
}

FCL_STPBV_VECTORIZED
double gapAlong(const KeptPlane& plane, const Isometry3d& frameA, const Isometry3d& frameB,
                const SphereCentre& a, const SphereCentre& b, double radius, double halfR) {
  const Packed u = turned(frameA, plane.outward[0]), w = turned(frameB, plane.outward[1]), t = u + w;
  const double turn2 = dot(t, t);
  double rise = radius * std::sqrt(turn2);
  if (halfR < kInfinity) rise = std::min(rise, halfR * turn2 - dot(turned(frameB, plane.touching), t));
  return dot(u, b.at - a.at) - plane.height - rise;
}

}  // namespace fcl_stpbv::detail
