// The pairs to check: pairs of a robot's bodies, and pairs of a body and an obstacle.
#pragma once

#include <fcl/narrowphase/collision_object.h>

#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/srdf.h"

namespace fcl_stpbv {

/// A pair to check: a body of the robot and another body or an obstacle.
struct CheckedPair {
  int body;               ///< index into RobotGeometry::bodies
  int other;              ///< index of the other body, or of the obstacle
  bool obstacle = false;  ///< whether `other` is an obstacle
};

/// A static obstacle. Do not change its geometry after it was given to a checker, to constraints or to a
/// motion check: they check its vertices and boxes only once.
class Obstacle {
 public:
  /// `pose` is in the world (see place()). @throws Error naming the obstacle for a null geometry.
  Obstacle(const std::string& name, std::shared_ptr<const fcl::CollisionGeometryd> geometry,
           const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity());

  /// Moves it to another pose. A rotation that is off by up to 1e-6 is replaced by the nearest exact one. At
  /// a pose that is not a rotation and a translation, nothing is clear of the obstacle.
  void place(const Eigen::Isometry3d& pose);

  /// The geometry that queries use.
  const std::shared_ptr<const fcl::CollisionGeometryd>& geometry() const { return geometry_; }
  /// Pose in the world; its rotation is exact up to rounding.
  const Eigen::Isometry3d& pose() const { return pose_; }
  /// Centre of a bounding sphere, in the world (m).
  const Eigen::Vector3d& centre() const { return centre_; }
  /// Radius of that sphere (m); infinite for a half space or a plane, and if no sphere is known.
  double radius() const { return radius_; }

  std::string name;  ///< for messages and reports
  std::shared_ptr<const fcl::CollisionGeometryd>
      primitive;                                        ///< the primitive under its smooth cover, else null
  std::shared_ptr<const fcl::CollisionGeometryd> full;  ///< Body::full, if the obstacle is a body of a scene
  double volumeExcess = 0;  ///< Body::volumeExcess, if the obstacle is a body of a scene (m)

 private:
  std::shared_ptr<const fcl::CollisionGeometryd> geometry_;
  Eigen::Isometry3d pose_;
  Eigen::Vector3d centre_;
  double radius_;
};

/// Makes an obstacle of an FCL object at its current pose. @throws Error as the constructor does.
Obstacle obstacleOf(const fcl::CollisionObjectd& object, const std::string& name);

/// The names of a pair's bodies. @throws Error as requireBodies() does.
std::string nameOf(const CheckedPair& pair, const RobotGeometry& geometry,
                   const std::vector<Obstacle>& obstacles);

/// Checks the indices of a pair. @throws Error for a body or an obstacle that does not exist, or for a body
/// paired with itself; the message starts with `who`.
void requireBodies(const CheckedPair& pair, const RobotGeometry& geometry, std::size_t obstacles,
                   const std::string& who);

/// The bodies of a scene's URDF as obstacles, with its joints at their neutral values.
std::vector<Obstacle> obstaclesOf(std::shared_ptr<const RobotModel> scene, const RobotGeometry& geometry);

/// All pairs of bodies of different links, without those that `srdf` leaves out; without an SRDF (null),
/// without those of adjacent and rigidly joined links (adjacency.h).
std::vector<CheckedPair> selfPairs(const RobotModel& robot, const RobotGeometry& geometry, const Srdf* srdf);

/// The links that a pair's bodies belong to, or the link and the obstacle.
LinkPair linksOf(const CheckedPair& pair, const RobotGeometry& geometry);

/// Every body of one link against every body of the other. If the pair is in RobotGeometry::byParts, their
/// convex parts instead of the whole bodies.
std::vector<CheckedPair> pairsOfLinks(const RobotGeometry& geometry, int link1, int link2);

/// Every body of a link against one obstacle.
std::vector<CheckedPair> pairsWithObstacle(const RobotGeometry& geometry, int link, int obstacle);

/// The pairs of bodies of two links, or of a link and an obstacle.
std::vector<CheckedPair> bodiesOf(const RobotGeometry& geometry, const LinkPair& pair);

namespace detail {

/// The bodies, links and obstacles that occur in some pairs. Each index once, ascending.
struct PairedBodies {
  std::vector<int> bodies;     ///< into RobotGeometry::bodies
  std::vector<int> links;      ///< into RobotModel::links, of these bodies
  std::vector<int> obstacles;  ///< into the scene's obstacles
};
/// The bodies, links and obstacles of `pairs`.
PairedBodies pairedBodies(const std::vector<CheckedPair>& pairs, const RobotGeometry& geometry);

}  // namespace detail

/// Makes sure that there is a pair to check, because a robot that was not checked is not proven clear. `why`
/// explains in the message why no pair is left.
/// @throws Error naming the robot's file and what would work, unless `checked` is above 0.
void requirePairs(std::size_t checked, const RobotModel& robot, const std::string& why);

/// Whether a joint, or the base, moves the link. @throws Error for a link that does not exist.
bool moves(const RobotModel& robot, int link, bool baseMoves = false);

/// Every body against every obstacle, except bodies that neither a joint nor the base moves.
std::vector<CheckedPair> obstaclePairs(const RobotModel& robot, const RobotGeometry& geometry,
                                       std::size_t obstacles, bool baseMoves = false);

/// Replaces primitives by their smooth covers (STP-BVs around them), until every pair has an STP-BV. Then
/// every distance is C1 (docs/theory.md, 5). A plain capsule is not smooth enough: when two of them, or a
/// capsule and a box, turn through a parallel position, the gradient jumps. The function does not change
/// bodies that are STP-BVs already. Nor does it change meshes that shall stay flat, so a pair of two such
/// meshes gets no STP-BV.
///
/// It is a greedy choice. First it covers the bodies with the smallest over-cover per pair that they make
/// smooth. Then it removes covers that are no longer needed, the largest over-cover first. The result is
/// deterministic, but may have a few more covers than necessary. `scene` contains the bodies that `pairs`
/// name as obstacles, in their order; null without obstacles. @throws Error as requireBodies() does, and for
/// a cover that cannot be built.
void coverPrimitives(const std::vector<CheckedPair>& pairs, RobotGeometry& robot,
                     RobotGeometry* scene = nullptr);

}  // namespace fcl_stpbv
