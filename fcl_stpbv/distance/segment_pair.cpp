// Two capsules: the points of two segments that are nearest to each other, in closed form (Lumelsky 1985;
// Ericson, Real-Time Collision Detection, 5.1.9).
//
// 1. Take the point of the first segment that is nearest to the line of the second, or, for parallel
//    segments, to the middle of the second.
// 2. Project it onto the second segment, and the result back onto the first. This corrects the points if a
//    segment ends before.
#include <algorithm>

#include "fcl_stpbv/distance/shape_pair.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {

FCL_STPBV_VECTORIZED
bool oppositeSegments(const ShapePair& p, OppositePoints& found) {
  if (p.a.kind != ShapeKind::segment || p.b.kind != ShapeKind::segment) return false;
  const Packed axis = p.pose.rotation.axis(2), &middle = p.pose.translation, z{0, 0, 1, 0};
  const auto within = [](double x, double half) { return std::clamp(x, -half, half); };
  const double cosine = axis[2], sine2 = axis[0] * axis[0] + axis[1] * axis[1],
               across = axis[0] * middle[0] + axis[1] * middle[1];
  double s = within(sine2 > 0.0 ? middle[2] - cosine * across / sine2 : middle[2], p.a.half);
  const double t = within(s * cosine - dot(axis, middle), p.b.half);
  s = within(middle[2] + t * cosine, p.a.half);
  found.onA = Eigen::Vector3d(0.0, 0.0, s);
  return p.isNearest(middle + t * axis - s * z, found);
}

}  // namespace fcl_stpbv::detail
