// Proofs that two links never meet, by branch and bound over the joints' ranges, in pieces
// that can be shared out: each is a pure function of its boxes, and what pieces find is
// put together in any order (docs/proofs.md).
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

/// What proofs need of a robot, made once for all its pairs.
struct ProofScene {
  std::shared_ptr<const Kinematics> kinematics;       ///< never null
  std::shared_ptr<const RobotGeometry> geometry;      ///< never null
  std::vector<Obstacle> obstacles;                    ///< that links are proven clear of
  double margin = 0;                                  ///< a distance not above it is a collision (m)
  std::shared_ptr<const detail::ProofBodies> bodies;  ///< of both, as points with balls around them
};

/// @throws Error where a body's over-cover cannot be measured.
ProofScene proofScene(std::shared_ptr<const Kinematics> kinematics,
                      std::shared_ptr<const RobotGeometry> geometry, std::vector<Obstacle> obstacles,
                      double margin);

/// Ranges of the coordinates that the pair's distance depends on, in the
/// order of proofCoordinates() (rad or m).
struct JointBox {
  Eigen::VectorXd lower;  ///< of each coordinate in turn
  Eigen::VectorXd upper;  ///< not below `lower`
};

/// How far a proof has come.
struct PairProof {
  std::vector<JointBox> open;                ///< what remains to be looked at
  std::optional<Eigen::VectorXd> collision;  ///< a configuration (all coordinates) in which the pair collides
  long boxes = 0;                            ///< looked at so far

  /// Whether nothing is left to look at and nothing collided.
  bool proven() const { return open.empty() && !collision; }
};

/// The coordinates that a pair's distance depends on, as indices into q, ascending. @throws Error, as all
/// below do, for a link without bodies or a link or an obstacle that does not exist, and for a box of other
/// coordinates.
std::vector<int> proofCoordinates(const ProofScene& scene, const LinkPair& pair);

/// The proof before its first step: one box of all the coordinates' limits.
PairProof unproven(const ProofScene& scene, const LinkPair& pair);

/// Looks at up to `maxBoxes` boxes, starting with the last of these, cutting those that a bound does not
/// clear; stops at a collision. What a box gives depends on the box alone, so that the same boxes and budget
/// always give the same result, and a proof that goes on from `open` ends as if it had not been interrupted.
/// Boxes without limits stay open, and so do all across planar and floating joints and a moving base.
PairProof provePair(const ProofScene& scene, const LinkPair& pair, std::vector<JointBox> boxes,
                    long maxBoxes);

/// The bound that proofs rest on: in this box the pair's distance is nowhere below it (m).
double distanceBound(const ProofScene& scene, const LinkPair& pair, const JointBox& box);

/// What two pieces of one pair's proof have found together. Associative and commutative: open boxes are
/// sorted, of several collisions the first in lexical order is kept, and a collision needs no open boxes.
PairProof merge(PairProof one, PairProof other);

}  // namespace fcl_stpbv
