// Support points of convex bodies: all that GJK, EPA and the direction cone need to know about a body.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/convex/shape.h"

namespace fcl_stpbv::detail {

/// The support point of a convex core along an outward unit normal, in the body's frame.
struct SupportPoint {
  Eigen::Vector3d n;       ///< the normal
  int patch;               ///< patch of an STP-BV that owns it; -1 for any other body
  Eigen::Vector3d anchor;  ///< a point near the core's point, of small coordinates
  double rise;             ///< height of the supporting plane above it, free of cancellation (m)
  Eigen::Vector3d point;   ///< the core's point furthest along the normal

  /// Height of `y` above the supporting plane (m).
  double gap(const Eigen::Vector3d& y) const { return n.dot(y - anchor) - rise; }
};

/// The support concept: any type with a function `supportPoint(body, n)` (as Jolt's
/// `ConvexSupport::GetSupport`). This one is for a bounded simple shape. An STP-BV's core
/// (distance/shape_ascent.h) also remembers the last patch.
inline SupportPoint supportPoint(const Shape& shape, const Eigen::Vector3d& n) {
  const Eigen::Vector3d p = shape.support(n);
  return {n, -1, p, 0.0, p};
}

/// The difference B - A of two convex cores in A's frame, by its support points.
template <typename A, typename B>
class ConvexDifference {
 public:
  /// A point of the difference.
  struct Corner {
    Eigen::Vector3d w{0, 0, 0};    ///< the point (m)
    Eigen::Vector3d onA{0, 0, 0};  ///< A's part of it
    double gap = 0;                ///< gap between the supporting planes of its normal (m)
  };

  ConvexDifference(A& a, B& b, const RelativePose& pose) : a_(a), b_(b), pose_(pose) {}

  /// The corner furthest against the unit vector `n`, from A to B.
  Corner support(const Eigen::Vector3d& n) {
    const SupportPoint p = supportPoint(a_, n), q = supportPoint(b_, pose_.opposite(n));
    return {pose_.placed(q.point) - p.point, p.point, p.gap(pose_.placed(q.anchor)) - q.rise};
  }

 private:
  A& a_;
  B& b_;
  const RelativePose& pose_;
};

}  // namespace fcl_stpbv::detail
