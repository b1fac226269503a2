// Continuous collision check of a robot: proves that no pair comes within a margin on a straight motion from
// one configuration to another.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <vector>

#include "fcl_stpbv/adapter/continuous_collide.h"
#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/robot/checked_pairs.h"
#include "fcl_stpbv/robot/kinematics.h"
#include "fcl_stpbv/robot/link_geometry.h"

namespace fcl_stpbv {

/// The least distance of a pair that was found on a motion.
struct Approach {
  /// Found at `time` (m). Infinite if none was asked for, minus infinity if the pair had no distance there.
  double distance = std::numeric_limits<double>::infinity();
  double time = 0;  ///< from 0 to 1
};

/// Checks motions of one robot among obstacles. It caches each pair's normal from one check to the next. Not
/// thread-safe: only one thread at a time may use it.
///
/// A motion is a straight line from q0 to q1 over the time from 0 to 1. Exact distances are computed at some
/// times. Between them, a bound on how far the bodies' points move along the normal proves that the pair is
/// clear (docs/motion.md). A pair's separating plane is fixed to the last link that carries both bodies.
class MotionCheck {
 public:
  using ConstVector = Eigen::Ref<const Eigen::VectorXd>;  ///< a configuration

  /// @throws Error for an empty list of pairs, because then nothing would be proven, and for a pair that
  /// names a body or an obstacle that does not exist.
  MotionCheck(std::shared_ptr<const Kinematics> kinematics, std::shared_ptr<const RobotGeometry> geometry,
              std::vector<CheckedPair> pairs, std::vector<Obstacle> obstacles = {});
  /// Moves the contents of another object, which may only be destroyed or assigned to afterwards.
  MotionCheck(MotionCheck&&) noexcept;
  /// The same.
  MotionCheck& operator=(MotionCheck&&) noexcept;
  ~MotionCheck();

  /// The pairs given.
  const std::vector<CheckedPair>& pairs() const;
  /// The robot.
  const Kinematics& kinematics() const;

  /// Whether no pair is within `margin` (m) at q. Stops at the first pair that is. False for a q that is not
  /// finite or has a wrong size; the functions below do not call such a motion free either.
  bool isFree(const ConstVector& q, double margin = 0);

  /// Whether no pair comes within `margin` (m) on the whole motion. This is a proof, not a test of samples.
  /// False if it cannot be decided, for example for a half space or plane of the robot that rotates relative
  /// to the other body.
  bool isMotionFree(const ConstVector& q0, const ConstVector& q1, double margin = 0);

  /// isMotionFree() that also finds the pair of the first contact, and brackets its time to the request's
  /// tolerance. Undecided for a q that is not finite or has a wrong size.
  MotionBracket firstContact(const ConstVector& q0, const ConstVector& q1, const MotionRequest& request = {});

  /// Updates each pair's least distance in `best` with the motion from q0 to q1. Afterwards it is proven that
  /// no pair comes nearer than its `best` minus `precision` (m) on this motion. Times are those of the motion
  /// plus `offset`. Returns false if this could not be proven. For a q that is not finite or has a wrong size
  /// all of `best` is minus infinity.
  bool closest(const ConstVector& q0, const ConstVector& q1, double precision, double offset,
               std::vector<Approach>& best);

  /// Distance of a pair at q, with witness points and normal (world, m). Status `invalid` for a q that is not
  /// finite or has a wrong size. @throws Error for a pair that does not exist.
  DistanceAnswer answer(int pair, const ConstVector& q);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fcl_stpbv
