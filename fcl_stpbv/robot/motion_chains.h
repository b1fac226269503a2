// How the bodies of a robot's pairs move along the straight line between two configurations.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "fcl_stpbv/adapter/motion_search.h"
#include "fcl_stpbv/adapter/posed_geometry.h"
#include "fcl_stpbv/robot/collision_checker.h"

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
    Eigen::Vector3d centre;  ///< of its ball, in the link's frame (m)
    double radius;           ///< of that ball (m)
    bool finite;             ///< its corners are numbers, if it is a mesh
    bool convex;
    ConvexBody body;
    Eigen::Vector3d where{0, 0, 0};  ///< the ball's centre, now (m, world)
  };
  /// One body of a pair, and the joints that move it.
  struct Side {
    int body;               ///< among the bodies
    int firstHop, lastHop;  ///< joints of the chain, inner ones first
    double acceleration = 0;
    bool steady = false;  ///< at most one joint turns, about an axis that its parent holds
  };
  struct Pair {
    Side side[2];
    int root;  ///< the link that both are seen from, -1 for the world
  };

  /// All must outlive this.
  /// @throws Error for a pair that names no body.
  MotionChains(const Kinematics& kinematics, const RobotGeometry& geometry,
               const std::vector<Obstacle>& obstacles, const std::vector<CheckedPair>& pairs);

  /// Between which configurations. False where they are not of the robot's size or not finite.
  bool set(const ConstVector& q0, const ConstVector& q1);
  /// The same, and the bounds on accelerations.
  bool begin(const ConstVector& q0, const ConstVector& q1);
  /// Everything at time `t`.
  void place(double t);

  const Pair& pair(int index) const { return pairs_[static_cast<std::size_t>(index)]; }
  const Placed& body(const Side& side) const { return bodies_[static_cast<std::size_t>(side.body)]; }
  /// Of a pair's body, seen from the pair's root, of a point at `about` (world).
  BodyVelocity velocityOf(const Pair& pair, int side, const Eigen::Vector3d& about) const;
  /// What rounding may add to a height over a plane (m).
  double slack() const { return slack_; }

 private:
  struct Hop {  // a joint on the way out from the root, with what the motion at hand makes of it
    double slide = 0, spin = 0, turns = 1;  // speeds, and own acceleration in spin^2 times lever
    double length = 0;                      // from the joint before to its child's origin at most
  };
  void addBodies(const RobotGeometry& geometry, const std::vector<Obstacle>& obstacles);
  void addPair(const CheckedPair& pair, int bodies);
  Side sideOf(int body, int root);
  void prepare(Side& side) const;

  const Kinematics& kinematics_;
  std::vector<Placed> bodies_;
  std::vector<Pair> pairs_;
  std::vector<int> hops_;              // joints of all chains
  std::vector<int> parent_;            // of each link
  std::vector<std::vector<int>> own_;  // motions that a link adds to its parent's
  std::vector<int> motionOf_;          // first motion of each joint, -1 for none; the base's is the last
  Kinematics::State state_;
  std::vector<Twist> twist_;  // of each link, per unit of time
  std::vector<Hop> hop_;      // of each joint, the base's last
  Eigen::VectorXd q0_, way_, q_;
  double reach_ = 0;  // how far a joint's child comes from the joint, with the way it slides, at most (m)
  double slack_ = 0;
};

}  // namespace fcl_stpbv::detail
