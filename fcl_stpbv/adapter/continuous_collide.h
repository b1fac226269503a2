// The drop-in for fcl::continuousCollide: a motion is proven free, or its first contact is bracketed.
#pragma once

#include <fcl/math/motion/motion_base.h>
#include <fcl/narrowphase/continuous_collision_object.h>
#include <fcl/narrowphase/continuous_collision_request.h>
#include <fcl/narrowphase/continuous_collision_result.h>

#include <Eigen/Geometry>

#include "fcl_stpbv/adapter/fcl_distance.h"

namespace fcl_stpbv {

/// Over the time from 0 to 1 the body turns evenly about an axis that moves evenly: FCL's translations,
/// interpolations and screws. The axis is given by the velocity of the body's origin around it: that stays
/// bounded for tiny rotations, whose axis may be anywhere.
struct SteadyMotion {
  Eigen::Isometry3d begin = Eigen::Isometry3d::Identity();  ///< pose at the time 0
  Eigen::Vector3d linear{0, 0, 0};  ///< velocity of the axis (world, m per unit of time)
  /// Velocity of the body's origin around the axis at the time 0, across `angular`: angular x (origin - a
  /// point of the axis). It turns with the body.
  Eigen::Vector3d turning{0, 0, 0};
  Eigen::Vector3d angular{0, 0, 0};  ///< rad per unit of time

  /// The pose at the time t. `velocity`, optional, gets that of the body's origin.
  Eigen::Isometry3d at(double t, Eigen::Vector3d* velocity = nullptr) const;
};

/// Between two poses as FCL would move: CCDM_TRANS (the rotation stays that of the
/// beginning), CCDM_LINEAR (the origin on a line) or CCDM_SCREW. False for poses that are not
/// rigid and for CCDM_SPLINE, which FCL leaves open.
bool steadyMotion(const Eigen::Isometry3d& begin, const Eigen::Isometry3d& end, fcl::CCDMotionType type,
                  SteadyMotion& motion);

/// What one of FCL's motion objects does. One exception: a screw that turns by less than 1e-10 goes to its
/// end pose, while FCL's goes the way times its own length. False for splines and types of others, also those
/// derived from FCL's, which may go another way. An `fcl::InterpMotion` that turns and was made without a
/// reference point moves about whatever the memory held there (FCL 0.7 leaves it unset), and so does the
/// answer; false where that is not within 1e6 m. Give one, or ask between two poses.
bool steadyMotion(const fcl::MotionBased& motion, SteadyMotion& result);

/// What became of a motion.
enum class MotionVerdict {
  free,       ///< proven: at no time does a pair come within the margin
  contact,    ///< one does, first between `from` and `until`
  undecided,  ///< free until `from`; after that the distance equals the margin to rounding, or it took too
              ///< many queries: whether and when there is a contact is not known
};

/// What is asked about a motion.
struct MotionRequest {
  /// A distance not above it is a contact (m); two meshes or trees have none below 0.
  double margin = 0;
  /// Of the time of contact, as a share of the motion, at least 1e-12; 1 for any contact
  /// instead of the first.
  double tolerance = 1e-4;
  /// Most distances asked for, or 1000 for each pair where that is more; the rest is undecided.
  long mostQueries = 200000;
};

/// What becomes of pairs over the time from 0 to 1.
struct MotionBracket {
  MotionVerdict verdict = MotionVerdict::free;  ///< of all pairs together
  double from = 1;                              ///< proven free before it
  double until = 1;  ///< in contact at it; 1 for a free motion; where nothing is decided the end of the time
                     ///< that was looked at last
  int pair = -1;     ///< the one in contact, or not decided
  long queries = 0;  ///< distances asked for
  bool tooMany = false;  ///< not decided because these exceed MotionRequest::mostQueries
};

/// What became of a motion over the time from 0 to 1.
struct MotionAnswer {
  MotionVerdict verdict = MotionVerdict::undecided;  ///< free, in contact or undecided
  double from = 0;                                   ///< proven free before it
  double until = 0;  ///< in contact at it; at most the tolerance after `from`. 1 for a free motion; where
                     ///< nothing is decided the end of the time that was looked at last
  DistanceAnswer answer;  ///< at `until`, which is the end of a free motion
  long queries = 0;       ///< distances asked for
};

/// Whether two moving bodies stay apart: exact distances, and between them a bound on how far the bodies'
/// points move along the normal (moving_bodies.h; docs/motion.md). Never throws. Undecided from 0 on for a
/// pair that has no distance; but a tree whose cells are all free meets nothing. The corners of a mesh, and
/// boxes that FCL has merged, are looked at once a motion.
MotionAnswer firstContact(const fcl::CollisionGeometryd& geometry1, const SteadyMotion& motion1,
                          const fcl::CollisionGeometryd& geometry2, const SteadyMotion& motion2,
                          const MotionRequest& request = {});

/// In the shape of `fcl::continuousCollide`: returns the time of contact, 1 if
/// there is none, and fills `result`.
///
/// `toc_err` is the tolerance and `ccd_motion_type` the motion; all else in the request changes nothing.
/// `is_collide` is false only where the motion is proven free. `time_of_contact` and the poses are those
/// of `MotionAnswer::until`, in contact; of an undecided motion those of `MotionAnswer::from`, until which it
/// is proven free, not in contact but for rounding or not at all. Either way it is at most `toc_err` after
/// the first contact, if there is one. -1 with `is_collide` at time 0 for what has no answer: splines, poses
/// that are not rigid, pairs without a distance. What FCL's marks call free or unknown meets nothing, as in
/// collide().
double continuousCollide(const fcl::CollisionGeometryd* geometry1, const fcl::MotionBased* motion1,
                         const fcl::CollisionGeometryd* geometry2, const fcl::MotionBased* motion2,
                         const fcl::ContinuousCollisionRequestd& request,
                         fcl::ContinuousCollisionResultd& result);
/// The same between two poses each.
double continuousCollide(const fcl::CollisionGeometryd* geometry1, const fcl::Transform3d& begin1,
                         const fcl::Transform3d& end1, const fcl::CollisionGeometryd* geometry2,
                         const fcl::Transform3d& begin2, const fcl::Transform3d& end2,
                         const fcl::ContinuousCollisionRequestd& request,
                         fcl::ContinuousCollisionResultd& result);
/// The same from where two objects are.
double continuousCollide(const fcl::CollisionObjectd* object1, const fcl::Transform3d& end1,
                         const fcl::CollisionObjectd* object2, const fcl::Transform3d& end2,
                         const fcl::ContinuousCollisionRequestd& request,
                         fcl::ContinuousCollisionResultd& result);
/// FCL's name for the same about objects that carry their motion.
double collide(const fcl::ContinuousCollisionObjectd* object1, const fcl::ContinuousCollisionObjectd* object2,
               const fcl::ContinuousCollisionRequestd& request, fcl::ContinuousCollisionResultd& result);

}  // namespace fcl_stpbv
