// The cached separating plane of a pair, and a lower bound on the gap along it after both bodies have moved.
#pragma once

#include <Eigen/Geometry>

#include "fcl_stpbv/packed.h"

namespace fcl_stpbv::detail {

/// A plane, stored in the frames of both bodies.
struct KeptPlane {
  Packed outward[2];  ///< outward unit normal of each body, in its own frame
  double height;      ///< sum of the heights of both supporting planes over the spheres' centres (m)
  Packed touching;    ///< where the second body touches its plane, relative to its centre, in its frame (m)
};

/// A struct, because Packed alone as a template argument would lose its alignment.
struct SphereCentre {
  Packed at;  ///< position in the world; the fourth number is 1
};

inline Packed turned(const Eigen::Isometry3d& frame, const Packed& v) {
  return v[0] * column(frame, 0) + v[1] * column(frame, 1) + v[2] * column(frame, 2);
}

/// Square of how far the bodies have turned relative to each other since a plane was stored (rad^2).
double turnSince(const KeptPlane& plane, const Eigen::Isometry3d& frameA, const Eigen::Isometry3d& frameB);

/// Lower bound on the gap along a cached plane at the present poses (m). `radius`: radius of the second
/// body's bounding sphere (m); `halfR`: half its R, infinite if it is no STP-BV (m).
///
/// Let u be the first body's stored direction, and w the second body's. When the plane was stored, w was -u;
/// now they differ by t = u + w. The second body's support along -u has two upper bounds. First, the support
/// function of a body within a ball of radius `radius` about its centre changes by at most radius |t|.
/// Second, an STP-BV lies in the ball of radius R that touches it at the plane; the support of that ball
/// along -u is higher by R |t|^2 / 2 - point.t.
double gapAlong(const KeptPlane& plane, const Eigen::Isometry3d& frameA, const Eigen::Isometry3d& frameB,
                const SphereCentre& a, const SphereCentre& b, double radius, double halfR);

}  // namespace fcl_stpbv::detail
