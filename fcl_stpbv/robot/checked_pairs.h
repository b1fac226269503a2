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
  int body;               ///< index into RobotGeometry::bodies
  int other;              ///< body, or index among the obstacles
  bool obstacle = false;  ///< whether `other` is an obstacle
};

/// Something that stands still in the world. Its geometry must not change once a checker, constraints or a
/// motion check has it: they look at its corners and boxes once.
struct Obstacle {
  std::string name;                                         ///< for messages and reports
  std::shared_ptr<const fcl::CollisionGeometryd> geometry;  ///< what queries get
  Eigen::Isometry3d pose;                                   ///< in the world; a rotation to rounding
  Eigen::Vector3d centre;                                   ///< of a sphere that holds it, in the world (m)
  double radius = 0;                                        ///< of that sphere (m)
  std::shared_ptr<const fcl::CollisionGeometryd>
      primitive;                                        ///< the primitive under its smooth cover, else null
  std::shared_ptr<const fcl::CollisionGeometryd> full;  ///< of a body of a scene, its Body::full
};

/// An FCL object as an obstacle, where it stands now; a rotation that is off by up to 1e-6 becomes the
/// nearest one.
Obstacle obstacleOf(const fcl::CollisionObjectd& object, const std::string& name);

/// The names of a pair's bodies. @throws Error as requireBodies() does.
std::string nameOf(const CheckedPair& pair, const RobotGeometry& geometry,
                   const std::vector<Obstacle>& obstacles);

/// @throws Error, as `who`, for a pair that names a body or an obstacle that does not exist, or a body twice.
void requireBodies(const CheckedPair& pair, const RobotGeometry& geometry, std::size_t obstacles,
                   const std::string& who);

/// The bodies of a scene's URDF, its joints at their neutral values.
std::vector<Obstacle> obstaclesOf(std::shared_ptr<const RobotModel> scene, const RobotGeometry& geometry);

/// All pairs of bodies of different links, without those that `srdf` leaves out; without an SRDF (null),
/// without those of adjacent and rigidly joined links (adjacency.h).
std::vector<CheckedPair> selfPairs(const RobotModel& robot, const RobotGeometry& geometry, const Srdf* srdf);

/// The links that a pair's bodies belong to, or the link and the obstacle.
LinkPair linksOf(const CheckedPair& pair, const RobotGeometry& geometry);

/// Every body of one link against every body of the other: their parts where the pair is taken by parts.
std::vector<CheckedPair> pairsOfLinks(const RobotGeometry& geometry, int link1, int link2);

/// Every body of a link against one obstacle.
std::vector<CheckedPair> pairsWithObstacle(const RobotGeometry& geometry, int link, int obstacle);

/// The bodies behind a pair of links, or of a link and an obstacle.
std::vector<CheckedPair> bodiesOf(const RobotGeometry& geometry, const LinkPair& pair);

namespace detail {

/// What some pairs are of. Each index once, ascending.
struct PairedBodies {
  std::vector<int> bodies;     ///< into RobotGeometry::bodies
  std::vector<int> links;      ///< into RobotModel::links, of these bodies
  std::vector<int> obstacles;  ///< into the scene's obstacles
};
/// The bodies, links and obstacles of `pairs`.
PairedBodies pairedBodies(const std::vector<CheckedPair>& pairs, const RobotGeometry& geometry);

}  // namespace detail

/// Refuses to go on without any pair to check: nothing checked is not clear.
/// `why` says what became of all pairs.
/// @throws Error naming the robot's file and what would work, unless `checked` is above 0.
void requirePairs(std::size_t checked, const RobotModel& robot, const std::string& why);

/// Whether a joint, or the base, moves the link. @throws Error for a link that does not exist.
bool moves(const RobotModel& robot, int link, bool baseMoves = false);

/// Every body against every obstacle, but for bodies that no joint moves.
std::vector<CheckedPair> obstaclePairs(const RobotModel& robot, const RobotGeometry& geometry,
                                       std::size_t obstacles, bool baseMoves = false);

/// Replaces primitives by their smooth covers (primitive_cover.h) until every pair has an STP-BV, which makes
/// its distance C1 (docs/theory.md, 5). A flat capsule is not enough: two of them jump where they turn
/// through parallel, as a capsule does along a box. Bodies that are smooth already are not touched, nor
/// meshes that were asked to stay flat: a pair of two of those stays without.
///
/// Chosen per body: those first whose cover exceeds the primitive least for each pair it settles,
/// then those are taken back, the largest excess first, that the others have made needless.
/// Deterministic; a few more covers than the fewest are possible. `scene` holds the bodies that
/// `pairs` name as obstacles, in their order; null without any. @throws Error for a pair of bodies
/// that do not exist, or a cover that cannot be built.
void coverPrimitives(const std::vector<CheckedPair>& pairs, RobotGeometry& robot,
                     RobotGeometry* scene = nullptr);

}  // namespace fcl_stpbv
