// Which pairs of links can meet at all: MoveIt's reasons for leaving a pair out, from samples, descents and
// proofs.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/robot/checked_pairs.h"
#include "fcl_stpbv/robot/kinematics.h"
#include "fcl_stpbv/robot/link_geometry.h"

namespace fcl_stpbv {

enum class PairReason {
  sometimes,     ///< collides in some configuration, which is given; to be checked
  adjacent,      ///< joined by a joint
  byDefault,     ///< collides in the neutral configuration
  always,        ///< collides in nearly every sample
  user,          ///< left out by the user's SRDF
  neverSampled,  ///< no collision in any sample, nor in descents from the closest ones
  neverProven,   ///< no collision within the joint limits
};

/// "Adjacent", "Default", "Always", "User", "Never", or "" for a pair to be checked, as in an SRDF.
const char* srdfReason(PairReason reason);
/// For people and reports: "never (proven)" and the like.
const char* reasonText(PairReason reason);

struct PairListOptions {
  int samples = 2000;
  std::uint64_t seed = 1;
  int descents = 3;   ///< from this many of a pair's closest samples
  double margin = 0;  ///< a distance not above it is a collision (m); FCL's own answers are 0 at overlap
  double alwaysFraction = 0.95;  ///< of the samples in collision, as MoveIt has it
  double proofSeconds = 0;       ///< time to spend on proofs in all; a pair that is not decided stays sampled
  int threads = 1;
  std::vector<Obstacle> obstacles;  ///< each is a pair with each link that joints or the base move
  std::function<void(std::size_t, std::size_t, const std::string&)> progress;
};

struct PairEntry {
  int link1, link2;       ///< link2: index among the obstacles where that is what it is
  bool obstacle = false;  ///< such an entry is never left out as adjacent or by default
  PairReason reason = PairReason::sometimes;
  int samples = 0, collisions = 0;
  double minDistance = 0;   ///< least found (m); that of the neutral configuration where nothing was sampled
  Eigen::VectorXd closest;  ///< the configuration it was found in
  bool byDescent = false;   ///< found by a descent, not by a sample
  double neutralDistance = 0;          ///< in the neutral configuration (m)
  double security = 0, influence = 0;  ///< proposed for an optimiser or a controller (m)

  /// With this confidence, 95 %, a random configuration collides with less than this probability: 3/n where
  /// none of n did.
  double probabilityBound() const { return collisions > 0 || samples == 0 ? 1 : 3.0 / samples; }
};

/// All pairs of links that have bodies, then those with obstacles. Deterministic for a seed, but for proofs
/// that their time cuts short.
///
/// `srdf` (or null) gives the user's own entries, of the reason "User" and of enable_collisions; its other
/// entries are found anew. @throws Error for a robot with more pairs than memory (4 GB) holds.
std::vector<PairEntry> pairList(std::shared_ptr<const Kinematics> kinematics,
                                std::shared_ptr<const RobotGeometry> geometry, const Srdf* srdf,
                                const PairListOptions& options = {});

/// The pairs of links to leave out, sorted by the links' names, for withPairs(). The user's own are not among
/// them.
std::vector<Srdf::Pair> toSrdf(const RobotModel& robot, const std::vector<PairEntry>& list);

}  // namespace fcl_stpbv
