// Straight motions of a robot proven free: from one configuration to another no pair comes within a margin.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/motion_search.h"
#include "fcl_stpbv/adapter/posed_geometry.h"
#include "fcl_stpbv/robot/checked_pairs.h"
#include "fcl_stpbv/robot/kinematics.h"
#include "fcl_stpbv/robot/link_geometry.h"

namespace fcl_stpbv {

/// The least distance of a pair over a motion, as far as is known.
struct Approach {
  double distance = std::numeric_limits<double>::infinity();  ///< found at `time` (m)
  double time = 0;
};

/// What checks the motions of one robot among obstacles; remembers each pair's normal from one check to the
/// next. One thread at a time may use one.
///
/// Between two exact distances a bound on how far the bodies' points move along the normal decides
/// (moving_bodies.h; docs/motion.md): a pair's plane is fixed to the last link that carries both bodies. A
/// motion is a straight line from q0 to q1 over the time from 0 to 1.
class MotionCheck {
 public:
  using ConstVector = Eigen::Ref<const Eigen::VectorXd>;

  /// @throws Error for a pair that names a body or an obstacle that does not exist.
  MotionCheck(std::shared_ptr<const Kinematics> kinematics, std::shared_ptr<const RobotGeometry> geometry,
              std::vector<CheckedPair> pairs, std::vector<Obstacle> obstacles = {});

  const std::vector<CheckedPair>& pairs() const { return pairs_; }
  const Kinematics& kinematics() const { return *kinematics_; }

  /// Whether no pair is within `margin` (m) at q; ends at the first that is. False for a q that is not
  /// finite.
  bool isFree(const ConstVector& q, double margin = 0);

  /// Whether all along the way no pair comes within `margin` (m): a proof, not samples. What cannot be
  /// decided is not free.
  bool isMotionFree(const ConstVector& q0, const ConstVector& q1, double margin = 0);

  /// The same with the first contact, bracketed to the request's tolerance, and its pair. Undecided for a q
  /// that is not finite.
  MotionBracket firstContact(const ConstVector& q0, const ConstVector& q1, const MotionRequest& request = {});

  /// Lowers each pair's `best` to what it comes to between q0 and q1, to within `precision` (m): nowhere is a
  /// pair nearer than its best less that. Times are those of the way plus `offset`. False where that could
  /// not be proven.
  bool closest(const ConstVector& q0, const ConstVector& q1, double precision, double offset,
               std::vector<Approach>& best);

  /// Distance of a pair at q, with points and normal (world).
  DistanceAnswer answer(int pair, const ConstVector& q);

 private:
  struct Hop {  // a joint on the way out from the plane's link, with what the motion at hand makes of it
    double slide = 0, spin = 0, turns = 1;  // speeds, and own acceleration in spin^2 times lever
    double length = 0;                      // from the joint before to its child's origin at most
  };
  struct Side {
    int body;               // among bodies_
    int firstHop, lastHop;  // joints of the chain, inner ones first
    double acceleration = 0;
  };
  struct Pair {
    Side side[2];
    int root;  // the link that the plane is fixed to, -1 for the world
    PairCache cache;
  };
  struct Placed {  // a body or an obstacle
    int link;      // -1 for an obstacle
    const fcl::CollisionGeometryd* geometry;
    Eigen::Isometry3d local;
    Eigen::Vector3d centre;  // of its ball, in the link's frame
    double radius;
    bool convex;
    ConvexBody body;
    Eigen::Vector3d where{0, 0, 0};  // the ball's centre, now
  };
  class Scene;
  class ApproachScene;

  void addBodies();
  void addPair(const CheckedPair& pair);
  Side sideOf(int body, int root);
  bool set(const ConstVector& q0, const ConstVector& q1);
  bool begin(const ConstVector& q0, const ConstVector& q1);
  void prepare(Side& side) const;
  void place(double t);
  Distance ask(Pair& pair);
  BodyVelocity velocityOf(const Side& side, int root, const Eigen::Vector3d& about) const;
  Cover ballCover(const Pair& pair, double margin, double most) const;
  Cover cover(const Pair& pair, const Distance& found, double margin, double most) const;

  std::shared_ptr<const Kinematics> kinematics_;
  std::shared_ptr<const RobotGeometry> geometry_;
  std::vector<Obstacle> obstacles_;
  std::vector<CheckedPair> pairs_;
  std::vector<Placed> bodies_;
  std::vector<Pair> moving_;
  std::vector<int> hops_;              // joints of all chains
  std::vector<int> parent_;            // of each link
  std::vector<std::vector<int>> own_;  // motions that a link adds to its parent's
  std::vector<int> motionOf_;          // first motion of each joint, -1 for none; the base's is the last
  Kinematics::State state_;
  std::vector<Twist> twist_;  // of each link, per unit of time
  std::vector<Hop> hop_;      // of each joint, the base's last
  Eigen::VectorXd q0_, way_, q_;
  double slack_ = 0;
};

}  // namespace fcl_stpbv
