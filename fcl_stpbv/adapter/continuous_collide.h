// Replacement for fcl::continuousCollide: proves that a motion is free of contacts, or brackets the time of
// the first contact.
#pragma once

#include <fcl/math/motion/motion_base.h>
#include <fcl/narrowphase/continuous_collision_object.h>
#include <fcl/narrowphase/continuous_collision_request.h>
#include <fcl/narrowphase/continuous_collision_result.h>

#include <Eigen/Geometry>

#include "fcl_stpbv/adapter/fcl_distance.h"

namespace fcl_stpbv {

/// A motion over the time from 0 to 1: the body rotates with constant angular velocity about an axis that
/// translates with constant velocity. This covers FCL's translations, interpolations and screws. The position
/// of the axis is stored as the velocity of the body's origin around it. That velocity stays bounded even for
/// tiny rotations, whose axis may be very far away.
struct SteadyMotion {
  Eigen::Isometry3d begin = Eigen::Isometry3d::Identity();  ///< pose at the time 0
  /// Velocity of the axis (world, m per unit of time; the motion takes 1 unit).
  Eigen::Vector3d linear{0, 0, 0};
  /// Velocity of the body's origin around the axis at time 0, perpendicular to `angular`: angular x (origin -
  /// a point of the axis) (world, m per unit of time). It rotates with the body.
  Eigen::Vector3d turning{0, 0, 0};
  Eigen::Vector3d angular{0, 0, 0};  ///< angular velocity (world, rad per unit of time)

  /// The pose at time t in [0, 1]. If `velocity` is given, it receives the velocity of the body's origin.
  Eigen::Isometry3d at(double t, Eigen::Vector3d* velocity = nullptr) const;
};

/// The motion between two poses of the given FCL type: CCDM_TRANS (the rotation stays that of `begin`),
/// CCDM_LINEAR (the origin moves on a line) or CCDM_SCREW. Returns false for poses that are not rigid, and
/// for CCDM_SPLINE, which FCL 0.7 does not implement for two poses.
bool steadyMotion(const Eigen::Isometry3d& begin, const Eigen::Isometry3d& end, fcl::CCDMotionType type,
                  SteadyMotion& motion);

/// The motion of one of FCL's motion objects. One difference: a screw that rotates by less than 1e-10 rad
/// ends at its end pose here, while FCL scales its translation by the translation's own length. Returns false
/// for splines and for types that are not FCL's, also for types derived from FCL's. Note on
/// `fcl::InterpMotion`: if it rotates and was made without a reference point, FCL 0.7 leaves that point
/// uninitialised, so both FCL's motion and this one are arbitrary. Returns false if the point is not within
/// 1e6 m. Give a reference point by the constructor `InterpMotion(R1, T1, R2, T2, O)`, or use the
/// overload for two poses. FCL's constructor `InterpMotion(tf1, tf2, O)` never computes the velocities: FCL's
/// object then moves by uninitialised numbers, while this motion goes from `tf1` to `tf2` about `O`.
bool steadyMotion(const fcl::MotionBased& motion, SteadyMotion& result);

/// The verdict on a motion.
enum class MotionVerdict {
  free,     ///< proven: no pair comes within the margin at any time
  contact,  ///< a pair comes within the margin, for the first time between `from` and `until`
  /// Free until `from`; whether there is a contact after that is not known, because the distance equals the
  /// margin up to rounding or because the search took too many queries.
  undecided,
};

/// Name of a verdict, as in reports.
constexpr const char* toString(MotionVerdict verdict) {
  switch (verdict) {
    case MotionVerdict::free:
      return "free";
    case MotionVerdict::contact:
      return "contact";
    case MotionVerdict::undecided:
      break;
  }
  return "undecided";
}

/// Parameters of a motion check.
struct MotionRequest {
  /// A distance at or below it is a contact (m). Two meshes or octrees have no distance below 0, so with a
  /// negative margin they have no contact.
  double margin = 0;
  /// Tolerance of the time of contact, as a fraction of the motion; at least 1e-12. With 1 any contact will
  /// do, not only the first.
  double tolerance = 1e-4;
  /// Limit on the number of distance queries; raised to 1000 for each pair if that is more. What is left then
  /// is undecided.
  long mostQueries = 200000;
};

/// Result for several pairs over the time from 0 to 1.
struct MotionBracket {
  MotionVerdict verdict = MotionVerdict::free;  ///< verdict on all pairs together
  double from = 1;                              ///< proven free before this time
  /// A pair is in contact at this time. 1 for a free motion. For an undecided motion, the end of the interval
  /// that was examined last.
  double until = 1;
  int pair = -1;         ///< index of the pair in contact, or of the undecided pair
  long queries = 0;      ///< number of distance queries
  bool tooMany = false;  ///< undecided because the search exceeded MotionRequest::mostQueries
};

/// Result for one pair over the time from 0 to 1.
struct MotionAnswer {
  MotionVerdict verdict = MotionVerdict::undecided;  ///< free, in contact or undecided
  double from = 0;                                   ///< proven free before this time
  /// The pair is in contact at this time, which is at most the tolerance after `from`. 1 for a free motion.
  /// For an undecided motion, the end of the interval that was examined last.
  double until = 0;
  DistanceAnswer answer;  ///< the distance at the time `until`; for a free motion that is the end
  long queries = 0;       ///< number of distance queries
};

/// Whether two moving bodies stay apart (docs/motion.md). It computes exact distances at some times. Between
/// two such times it bounds how far the bodies' points move along the normal. Never throws. A pair without a
/// distance is undecided from time 0 on, but an octree whose cells are all free meets nothing. The vertices
/// of a mesh and its boxes are checked once per motion.
MotionAnswer firstContact(const fcl::CollisionGeometryd& geometry1, const SteadyMotion& motion1,
                          const fcl::CollisionGeometryd& geometry2, const SteadyMotion& motion2,
                          const MotionRequest& request = {});

/// Replaces `fcl::continuousCollide`, with the same arguments: returns the time of contact, from 0 to 1, and
/// fills `result`. Returns 1 if there is no contact.
///
/// From the request it uses `toc_err` as the tolerance and `ccd_motion_type` as the type of motion, and
/// nothing else. `is_collide` is false only if the motion is proven free. With a contact, `time_of_contact`
/// and the poses are those at `MotionAnswer::until`, where the bodies are in contact. For an undecided motion
/// they are those at `MotionAnswer::from`: until then the motion is proven free, so the bodies are not in
/// contact there, except perhaps by rounding. In both cases the time is at most `toc_err` after the first
/// contact, if there is one. Without an answer it returns -1, with `is_collide` true and time 0: for splines,
/// poses that are not rigid, and pairs without a distance. A geometry that FCL marks as free or unknown has
/// no contacts, as in collide().
double continuousCollide(const fcl::CollisionGeometryd* geometry1, const fcl::MotionBased* motion1,
                         const fcl::CollisionGeometryd* geometry2, const fcl::MotionBased* motion2,
                         const fcl::ContinuousCollisionRequestd& request,
                         fcl::ContinuousCollisionResultd& result);
/// continuousCollide() for motions between two poses of each geometry.
double continuousCollide(const fcl::CollisionGeometryd* geometry1, const fcl::Transform3d& begin1,
                         const fcl::Transform3d& end1, const fcl::CollisionGeometryd* geometry2,
                         const fcl::Transform3d& begin2, const fcl::Transform3d& end2,
                         const fcl::ContinuousCollisionRequestd& request,
                         fcl::ContinuousCollisionResultd& result);
/// continuousCollide() for motions that start at the current poses of two objects.
double continuousCollide(const fcl::CollisionObjectd* object1, const fcl::Transform3d& end1,
                         const fcl::CollisionObjectd* object2, const fcl::Transform3d& end2,
                         const fcl::ContinuousCollisionRequestd& request,
                         fcl::ContinuousCollisionResultd& result);
/// continuousCollide() for objects that contain their motion, under FCL's name for it.
double collide(const fcl::ContinuousCollisionObjectd* object1, const fcl::ContinuousCollisionObjectd* object2,
               const fcl::ContinuousCollisionRequestd& request, fcl::ContinuousCollisionResultd& result);

}  // namespace fcl_stpbv
