// FCL's motions: a turn about an axis through a point that moves straight on.
#pragma once

#include <fcl/math/motion/motion_base.h>
#include <fcl/narrowphase/continuous_collision_request.h>

#include <Eigen/Geometry>

namespace fcl_stpbv {

/// Over the time from 0 to 1 the body turns evenly while the point moves evenly: FCL's
/// translations, interpolations and screws.
struct SteadyMotion {
  Eigen::Isometry3d begin = Eigen::Isometry3d::Identity();  ///< pose at the time 0
  Eigen::Vector3d point{0, 0, 0};                           ///< of the axis, at the time 0 (world, m)
  Eigen::Vector3d linear{0, 0, 0};                          ///< velocity of that point
  Eigen::Vector3d angular{0, 0, 0};                         ///< rad per unit of time

  /// The pose at the time t.
  Eigen::Isometry3d at(double t) const;
};

/// Between two poses as FCL would move: CCDM_TRANS (the rotation stays that of the
/// beginning), CCDM_LINEAR (the origin on a line) or CCDM_SCREW. False for poses that are not
/// rigid and for CCDM_SPLINE, which FCL leaves open.
bool steadyMotion(const Eigen::Isometry3d& begin, const Eigen::Isometry3d& end, fcl::CCDMotionType type,
                  SteadyMotion& motion);

/// What one of FCL's motion objects does. False for splines and types of others.
bool steadyMotion(const fcl::MotionBased& motion, SteadyMotion& result);

}  // namespace fcl_stpbv
