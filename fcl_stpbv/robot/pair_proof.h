// Proofs that two links never collide, by branch and bound over the ranges of the joints (docs/proofs.md). A
// proof can be split into pieces for several machines: the result of a piece depends only on its boxes, and
// results can be merged in any order.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "fcl_stpbv/robot/checked_pairs.h"
#include "fcl_stpbv/robot/kinematics.h"
#include "fcl_stpbv/robot/link_geometry.h"

namespace fcl_stpbv {

namespace detail {
struct ProofBodies;
}

/// The data of a robot for proofs, made once for all its pairs.
struct ProofScene {
  std::shared_ptr<const Kinematics> kinematics;   ///< never null
  std::shared_ptr<const RobotGeometry> geometry;  ///< never null
  std::vector<Obstacle> obstacles;                ///< the obstacles that pairs refer to
  double margin = 0;                              ///< a distance at or below it is a collision (m)
  /// The bodies of robot and obstacles as points with balls; internal.
  std::shared_ptr<const detail::ProofBodies> bodies;
};

/// Prepares the data for proofs. @throws Error if the over-cover of a body cannot be measured.
ProofScene proofScene(std::shared_ptr<const Kinematics> kinematics,
                      std::shared_ptr<const RobotGeometry> geometry, std::vector<Obstacle> obstacles,
                      double margin);

/// A box in configuration space: ranges of the coordinates that the pair's distance depends on, in the order
/// of proofCoordinates() (rad or m).
struct JointBox {
  Eigen::VectorXd lower;  ///< lower end of each range
  Eigen::VectorXd upper;  ///< upper end of each range, not below `lower`
};

/// State of a proof.
struct PairProof {
  std::vector<JointBox> open;                ///< boxes that are not examined yet
  std::optional<Eigen::VectorXd> collision;  ///< a configuration (all coordinates) in which the pair collides
  long boxes = 0;  ///< number of boxes examined by one call of provePair(), or by all that were merged

  /// Whether the proof is complete: no box is left, and there is no collision.
  bool proven() const { return open.empty() && !collision; }
};

/// The coordinates that a pair's distance depends on, as indices into q, ascending. This and all functions
/// below throw for wrong arguments. @throws Error for a link without bodies, a link or an obstacle that does
/// not exist, and a box with a wrong number of coordinates.
std::vector<int> proofCoordinates(const ProofScene& scene, const LinkPair& pair);

/// A proof before its first step: a single box with the limits of all coordinates.
PairProof unproven(const ProofScene& scene, const LinkPair& pair);

/// Examines up to `maxBoxes` boxes, starting with the last of `boxes`. A box that the bound does not prove
/// clear is cut in two. Stops at a collision. The result for a box depends only on that box. So the same
/// arguments always give the same result, and a proof that continues from `open` ends as if it had not been
/// interrupted. Infinite boxes stay open; so do all boxes if a planar or floating joint or a moving base lies
/// between the two. A box that is not clear and cannot be cut, such as one of a single configuration, stays
/// open too, before the others.
PairProof provePair(const ProofScene& scene, const LinkPair& pair, std::vector<JointBox> boxes,
                    long maxBoxes);

/// Lower bound on the pair's distance in the whole box (m); -infinity if there is none. Proofs are based on
/// it.
double distanceBound(const ProofScene& scene, const LinkPair& pair, const JointBox& box);

/// Merges the results of two pieces of one pair's proof. It is associative and commutative: open boxes are
/// sorted, and of several collisions the lexicographically first one is kept. With a collision the open boxes
/// are dropped.
PairProof merge(PairProof one, PairProof other);

}  // namespace fcl_stpbv
