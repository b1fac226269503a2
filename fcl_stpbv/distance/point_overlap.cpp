// Depth of an STP-BV and a simple shape whose cores overlap, if it equals the depth of a single point of the
// shape. The proof is in docs/theory.md, 5.
//
// 1. Take the shape's point that faces the volume along the start's normal.
// 2. Compute its shortest way out of the volume in closed form (volume/point_depth.h).
// 3. If no other point of the shape needs a longer way along that direction, the depth of the shape is that
//    of the point. Otherwise continue with the point that does, until the search alternates between points.
#include <algorithm>

#include "fcl_stpbv/distance/shape_query.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/point_depth.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

std::optional<LeastOverlap> overlapOfPoint(ShapeQuery& q, const StartNormal& start) {
  constexpr int kRounds = 8;  // one or two for corners, a few for round shapes
  constexpr int kFree = 2;    // rounds before steps must shrink
  // Of the last round's step. A larger step means that the search alternates between points.
  constexpr double kSlow = 0.25;
  Vector3d y = q.facing(start.n);
  double step = kInfinity;
  for (int i = 0; i < kRounds; ++i) {
    const std::optional<PointDepth> way = pointDepth(q.body, y);
    ++q.pairs;
    if (!way) break;
    const Vector3d last = q.facing(way->normal);
    const double next = (last - y).norm();
    if (next <= q.rounding.gap) {
      const SupportPoint view = viewVolume(q.body, way->normal, way->patch, q.steps);
      LeastOverlap found{{}, 0.0, true, true};
      found.at.n = way->normal;
      found.at.patch = view.patch;
      found.at.y = y;
      found.at.gap = view.gap(y);
      found.at.corners = 1;
      found.bound = std::max(-way->depth, found.at.gap) + q.rounding.across;
      if (!(found.at.gap >= -way->depth - q.rounding.gap)) break;
      return found;
    }
    if (i >= kFree && next > kSlow * step) break;
    step = next;
    y = last;
  }
  return {};
}

}  // namespace fcl_stpbv::detail
