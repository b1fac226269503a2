// How the bodies of a robot's pairs move along the straight line between two configurations.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "fcl_stpbv/adapter/motion_search.h"
#include "fcl_stpbv/adapter/posed_geometry.h"
#include "fcl_stpbv/robot/collision_checker.h"
#include "fcl_stpbv/robot/pose_rounding.h"

namespace fcl_stpbv::detail {

/// The poses and velocities of the bodies of all pairs at a time of the motion. Also, for each pair, a bound
/// on the acceleration of every point of both bodies, relative to the link where their chains meet. Time runs
/// from 0 to 1.
class MotionChains {
 public:
  using ConstVector = Eigen::Ref<const Eigen::VectorXd>;

  /// A body or an obstacle.
  struct Placed {
    int link;  ///< -1 for an obstacle
    const fcl::CollisionGeometryd* geometry;
    Eigen::Isometry3d local;
    Eigen::Vector3d centre;  ///< centre of its bounding ball, in the link's frame (m)
    double radius;           ///< radius of that ball (m)
    bool finite;             ///< whether all corners are finite, if the body is a mesh
    bool convex;
    ConvexBody body;
    Eigen::Vector3d where{0, 0, 0};  ///< present centre of the ball (m, world)
  };
  /// One body of a pair, and the joints that move it.
  struct Side {
    int body;               ///< index of the body
    int firstHop, lastHop;  ///< joints of the chain, inner ones first
    double acceleration = 0;
    bool steady = false;  ///< at most one joint turns, about an axis that is fixed to its parent
  };
  struct Pair {
    Side side[2];
    int root;  ///< the link relative to which both are described, -1 for the world
  };

  /// All arguments must outlive this object.
  /// @throws Error for a pair that names no body.
  MotionChains(const Kinematics& kinematics, const RobotGeometry& geometry,
               const std::vector<Obstacle>& obstacles, const std::vector<CheckedPair>& pairs);

  /// Sets the two configurations. False if they do not have the robot's size or are not finite.
  bool set(const ConstVector& q0, const ConstVector& q1);
  /// set(), and computes the bounds on accelerations.
  bool begin(const ConstVector& q0, const ConstVector& q1);
  /// Computes everything at time `t`.
  void place(double t);

  const Pair& pair(int index) const { return pairs_[static_cast<std::size_t>(index)]; }
  const Placed& body(const Side& side) const { return bodies_[static_cast<std::size_t>(side.body)]; }
  /// Velocity of a pair's body relative to the pair's root, at the point `about` (world).
  BodyVelocity velocityOf(const Pair& pair, int side, const Eigen::Vector3d& about) const;
  /// Upper bound on the rounding of a height over a plane (m).
  double slack() const { return slack_; }

 private:
  struct Hop {  // a joint on the way out from the root, with its data for the present motion
    double slide = 0, spin = 0, turns = 1;  // speeds; factor of spin^2 times lever in its own acceleration
    double length = 0;                      // largest distance from the joint before to its child's origin
  };
  void addBodies(const RobotGeometry& geometry, const std::vector<Obstacle>& obstacles);
  void addPair(const CheckedPair& pair, int bodies);
  Side sideOf(int body, int root);
  void prepare(Side& side) const;
  double longestLever() const;

  const Kinematics& kinematics_;
  std::vector<Placed> bodies_;
  std::vector<Pair> pairs_;
  std::vector<int> hops_;              // joints of all chains
  std::vector<int> parent_;            // parent of each link
  std::vector<std::vector<int>> own_;  // for each link: the motions that its joint adds to the parent's
  std::vector<int> motionOf_;          // first motion of each joint, -1 for none; the base's is the last
  Kinematics::State state_;
  std::vector<Twist> twist_;  // velocity of each link, per unit of time
  std::vector<Hop> hop_;      // for each joint, the base's last
  Eigen::VectorXd q0_, way_, q_;
  double reach_ = 0;  // largest distance of a joint's child from the joint, with the way it slides (m)
  PoseRounding rounding_;
  double wayRounding_ = 0;  // how far the rounding of q on the way moves a pair's bodies (m)
  double slack_ = 0;
};

}  // namespace fcl_stpbv::detail
