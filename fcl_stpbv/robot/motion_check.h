// Straight motions of a robot proven free: from one configuration to another no pair comes within a margin.
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

/// The least distance of a pair over a motion, as far as is known.
struct Approach {
  double distance = std::numeric_limits<double>::infinity();  ///< found at `time` (m)
  double time = 0;                                            ///< from 0 to 1
};

/// What checks the motions of one robot among obstacles; remembers each pair's normal from one check to the
/// next. One thread at a time may use one.
///
/// Between two exact distances a bound on how far the bodies' points move along the normal decides
/// (moving_bodies.h; docs/motion.md): a pair's plane is fixed to the last link that carries both bodies. A
/// motion is a straight line from q0 to q1 over the time from 0 to 1.
class MotionCheck {
 public:
  using ConstVector = Eigen::Ref<const Eigen::VectorXd>;  ///< a configuration

  /// @throws Error for no pairs, since nothing checked is not free, and for a pair that names a body or an
  /// obstacle that does not exist.
  MotionCheck(std::shared_ptr<const Kinematics> kinematics, std::shared_ptr<const RobotGeometry> geometry,
              std::vector<CheckedPair> pairs, std::vector<Obstacle> obstacles = {});
  /// Takes over all that the other one has; the other one may only be destroyed.
  MotionCheck(MotionCheck&&) noexcept;
  ~MotionCheck();

  /// The pairs given.
  const std::vector<CheckedPair>& pairs() const;
  /// The robot.
  const Kinematics& kinematics() const;

  /// Whether no pair is within `margin` (m) at q; ends at the first that is.
  /// False for a q that is not finite or has another size, as all below are not free for one.
  bool isFree(const ConstVector& q, double margin = 0);

  /// Whether all along the way no pair comes within `margin` (m): a proof, not samples. What cannot be
  /// decided is not free, such as a half space or plane of the robot that turns against the other body.
  bool isMotionFree(const ConstVector& q0, const ConstVector& q1, double margin = 0);

  /// The same with the first contact, bracketed to the request's tolerance, and its pair. Undecided for a q
  /// that is not finite or has another size.
  MotionBracket firstContact(const ConstVector& q0, const ConstVector& q1, const MotionRequest& request = {});

  /// Lowers each pair's `best` to what it comes to between q0 and q1, to within `precision`
  /// (m): nowhere is a pair nearer than its best less that. Times are those of the way plus
  /// `offset`. False where that could not be proven.
  bool closest(const ConstVector& q0, const ConstVector& q1, double precision, double offset,
               std::vector<Approach>& best);

  /// Distance of a pair at q, with points and normal (world). @throws Error for a pair that does not exist.
  DistanceAnswer answer(int pair, const ConstVector& q);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fcl_stpbv
