// The plane that kept a pair of bodies apart, and how far apart it still keeps them after both have moved.
#pragma once

#include <Eigen/Geometry>

#include "fcl_stpbv/packed.h"

namespace fcl_stpbv::detail {

/// A plane as both bodies saw it.
struct KeptPlane {
  Packed outward[2];  ///< unit, in each body's frame
  double height;      ///< of both supporting planes over the spheres' centres, summed (m)
  Packed touching;    ///< where the second body touches its plane, from its centre, in its frame (m)
};

/// A struct, because as a template's argument alone a Packed would lose its alignment.
struct SphereCentre {
  Packed at;  ///< in the world, and a 1
};

inline Packed turned(const Eigen::Isometry3d& frame, const Packed& v) {
  return v[0] * column(frame, 0) + v[1] * column(frame, 1) + v[2] * column(frame, 2);
}

/// How far the bodies have turned against each other since a plane was kept (rad, squared).
double turnSince(const KeptPlane& plane, const Eigen::Isometry3d& frameA, const Eigen::Isometry3d& frameB);

/// Least gap along a kept plane where the bodies are now (m). `radius`: of the second body's sphere; `bend`:
/// half its R, infinite where it is no STP-BV (m).
///
/// Along the first body's direction u the second body's direction w, then -u, is now t = u + w away from
/// that, and its support along -u is bounded twice: the support function of a body within a ball of radius
/// `radius` about its centre changes by at most radius |t|; and an STP-BV lies in the ball of radius R that
/// touches it where it touches its plane, whose support along -u is higher by R |t|^2 / 2 less point.t.
double gapAlong(const KeptPlane& plane, const Eigen::Isometry3d& frameA, const Eigen::Isometry3d& frameB,
                const SphereCentre& a, const SphereCentre& b, double radius, double bend);

}  // namespace fcl_stpbv::detail
