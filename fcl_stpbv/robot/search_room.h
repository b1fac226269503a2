// The size of a robot and its obstacles, and from it the range in which coordinates without limits, or with
// limits far beyond that size, are searched.
#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "fcl_stpbv/robot/checked_pairs.h"
#include "fcl_stpbv/robot/kinematics.h"

namespace fcl_stpbv::detail {

/// Largest distance of a link's bodies from the link's origin (m); infinite if a body has no end.
double reachOf(const RobotGeometry& geometry, int link);

/// The same of an obstacle from the world's origin.
double reachOf(const Obstacle& obstacle);

/// The longest way from the parent's origin to the child's, within the limits (m). For a planar or floating
/// joint, which has no limits, the way at zero.
double lengthOf(const RobotModel& robot, int joint);

/// The range in which each coordinate is searched, and the size of its steps.
struct SearchRoom {
  /// Within the limits. Coordinates that translate without limits (of planar and floating joints and of a
  /// moving base) end at twice as far as the robot and the obstacles reach, at least 1 m, less for tiny
  /// bodies. If two bodies can meet at all, they meet within it, without changes of the other joints. A half
  /// space or a plane counts as far as its nearest point, so a base that can only move nearly along it may
  /// meet it farther away. A body or an obstacle of which no size is known does not count. Joints
  /// that slide more than a hundred times as far, such as between limits of 1e16 m, end there, too.
  Eigen::VectorXd lower, upper;
  /// Unit of a step: 1 rad for a joint that turns. For a joint that slides it is `scale` (m), or more if the
  /// joint slides far. For a coordinate without limits it is the size of the room.
  Eigen::VectorXd unit;
  /// Scale of all distances (m): 1 if the largest body has a radius of 0.1 to 1 m, otherwise proportionally
  /// smaller or larger. So robots of any size are searched alike.
  double scale = 1;
  /// Coordinates whose limits are wider than `lower` and `upper`, and how many times those may be doubled.
  std::vector<Eigen::Index> narrowed;
  int doublings = 0;
};

SearchRoom searchRoom(const Kinematics& kinematics, const RobotGeometry& geometry,
                      const std::vector<Obstacle>& obstacles);

/// A configuration that is uniformly distributed in the room. If limits are wider, one in four configurations
/// is from a room that is larger by a random power of 2. The result is the same with every compiler.
Eigen::VectorXd randomConfiguration(const Kinematics& kinematics, const SearchRoom& room,
                                    std::mt19937_64& random);

}  // namespace fcl_stpbv::detail
