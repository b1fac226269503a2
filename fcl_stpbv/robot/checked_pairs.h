// Which bodies of a robot are to be kept apart: from each other, and from obstacles.
#pragma once

#include <fcl/narrowphase/collision_object.h>

#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/srdf.h"

namespace fcl_stpbv {

/// A body of the robot against another one, or against an obstacle.
struct CheckedPair {
  int body;
  int other;  ///< body, or index among the obstacles
  bool obstacle = false;
};

/// Something that stands still in the world.
struct Obstacle {
  std::string name;
  std::shared_ptr<const fcl::CollisionGeometryd> geometry;
  Eigen::Isometry3d pose;
  Eigen::Vector3d centre;  ///< of a sphere that holds it, in the world (m)
  double radius = 0;
  std::shared_ptr<const fcl::CollisionGeometryd>
      primitive;  ///< the primitive under its smooth cover, else null
};

Obstacle obstacleOf(const fcl::CollisionObjectd& object, const std::string& name);

/// The bodies of a scene's URDF, its joints at their neutral values.
std::vector<Obstacle> obstaclesOf(std::shared_ptr<const RobotModel> scene, const RobotGeometry& geometry);

/// Whether two links are joined by a joint, links without bodies between them not counting.
bool adjacent(const RobotModel& robot, const RobotGeometry& geometry, int link1, int link2);

/// All pairs of bodies of different links, without those that `srdf` leaves out; without an SRDF (null),
/// without those of adjacent links.
std::vector<CheckedPair> selfPairs(const RobotModel& robot, const RobotGeometry& geometry, const Srdf* srdf);

/// Every body of one link against every body of the other.
std::vector<CheckedPair> pairsOfLinks(const RobotGeometry& geometry, int link1, int link2);

/// Every body of a link against one obstacle.
std::vector<CheckedPair> pairsWithObstacle(const RobotGeometry& geometry, int link, int obstacle);

/// Whether a joint, or the base, moves the link.
bool moves(const RobotModel& robot, int link, bool baseMoves = false);

/// Every body against every obstacle, but for bodies that no joint moves.
std::vector<CheckedPair> obstaclePairs(const RobotModel& robot, const RobotGeometry& geometry,
                                       std::size_t obstacles, bool baseMoves = false);

}  // namespace fcl_stpbv
