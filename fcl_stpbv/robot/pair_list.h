// Finds which pairs of links can collide, and which pairs an SRDF can leave out, with MoveIt's reasons. It
// uses random samples, local minimisation (descents) and proofs.
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

/// Why a pair of links is checked, or left out.
enum class PairReason {
  sometimes,      ///< collides in some configuration, which the entry contains; must be checked
  adjacent,       ///< connected by one joint
  rigid,          ///< no joint moves one relative to the other
  byDefault,      ///< collides in the neutral configuration and in all other configurations tried
  defaultClears,  ///< collides in the neutral configuration, but is clear in another one; must be checked
  /// Collides in nearly every sample; must be checked. Two links are clear in the neutral configuration then;
  /// a link and an obstacle need not be.
  always,
  user,          ///< left out by the user's SRDF
  neverSampled,  ///< no collision in any sample or descent
  neverProven,   ///< proven: no collision within the joint limits
};

/// Text of a reason for reports, such as "never (proven)".
const char* reasonText(PairReason reason);

/// Whether a pair is checked if there is no SRDF: true for all reasons except adjacent, rigid, byDefault and
/// user.
bool checkedWithoutSrdf(PairReason reason);

/// Options of pairList(): how thoroughly it searches.
struct PairListOptions {
  int samples = 2000;      ///< random configurations
  std::uint64_t seed = 1;  ///< seed of the random configurations
  int descents = 3;        ///< number of descents per pair, from its closest samples
  /// Number of descents from random configurations, for a pair that is clear so far but not proven clear. The
  /// number is reduced for large problems: by the factor (24/n)^2 if n > 24, where n is the number of
  /// coordinates on which the pair depends, or of moving joints between its links if that is larger; and by
  /// the factor 100,000/(P N) if P N > 100,000, for a list of P pairs and a robot of N coordinates. A pair
  /// that the first proof proves clear gets at most 50, to find how close it comes.
  int randomDescents = 500;
  /// Limit on the boxes of the first proof, for each pair that is clear so far; reduced by the factor
  /// (24/n)^3 if n > 24.
  long proofBoxes = 200;
  /// Total time for further proofs (s); a pair that is undecided after it stays neverSampled.
  double proofSeconds = 0;
  double margin = 0;  ///< a pair collides if its distance is at most this (m)
  /// Fraction of samples in collision for the reason `always`, as in MoveIt; needs at least 60 samples.
  double alwaysFraction = 0.95;
  Eigen::VectorXd neutral;          ///< the neutral configuration; empty for Kinematics::neutral()
  int threads = 1;                  ///< number of threads
  std::vector<Obstacle> obstacles;  ///< each makes a pair with each link that joints or the base move
  std::function<void(std::size_t, std::size_t, const std::string&)>
      progress;  ///< called from time to time with the steps done, the number of all steps, and a text
};

/// One pair of the list, with the reason why it is checked or left out.
struct PairEntry : LinkPair {  ///< a pair with an obstacle is never left out as adjacent or by default
  PairReason reason = PairReason::sometimes;
  int samples = 0;     ///< configurations tried
  int collisions = 0;  ///< number of these in collision
  /// Least distance found (m); that of the neutral configuration if nothing was sampled.
  double minDistance = 0;
  Eigen::VectorXd closest;     ///< the configuration of `minDistance`
  bool byDescent = false;      ///< whether `minDistance` was found by a descent, not by a sample
  double neutralDistance = 0;  ///< distance in the neutral configuration (m)
  long boxes = 0;              ///< number of boxes that proofs examined
  double security = 0;         ///< proposed minimum distance for an optimiser or a controller (m)
  double influence = 0;        ///< proposed distance below which the pair becomes active, for the same (m)

  /// Upper bound on the probability that a random configuration collides, with 95 % confidence: 3/n if none
  /// of n samples collided (rule of three); 1 if one did, or if nothing was sampled.
  double probabilityBound() const { return collisions > 0 || samples == 0 ? 1 : 3.0 / samples; }
};

/// Checks that the search below fits into memory. @throws Error naming the robot's file, if the pairs of its
/// bodies and of bodies with this number of obstacles need more than 4 GB.
void requireRoomForPairs(const Kinematics& kinematics, const RobotGeometry& geometry, std::size_t obstacles);

/// Searches all pairs of links that have bodies, then the pairs with obstacles. Deterministic for a given
/// seed, except for proofs that `proofSeconds` interrupts.
///
/// `srdf` (or null) gives the user's own entries: those with the reason "User" and those in
/// enable_collisions. Its other entries are ignored and searched anew. @throws Error as requireRoomForPairs()
/// does.
std::vector<PairEntry> pairList(std::shared_ptr<const Kinematics> kinematics,
                                std::shared_ptr<const RobotGeometry> geometry, const Srdf* srdf,
                                const PairListOptions& options = {});

/// The pairs of bodies to check according to a list, if there is no SRDF.
std::vector<CheckedPair> checkedPairs(const RobotGeometry& geometry, const std::vector<PairEntry>& list);

/// Text with the number of pairs for each reason, such as "3 adjacent, 1 rigid".
std::string countsOf(const std::vector<PairEntry>& list);

/// The pairs of links to leave out, sorted by the links' names, for withPairs(). The user's own entries are
/// not included. Pairs that collide in the neutral configuration or in nearly every sample, but are clear in
/// another configuration, are included only with `defaultToo`. @throws Error for a link that the robot does
/// not have.
std::vector<Srdf::Pair> toSrdf(const RobotModel& robot, const std::vector<PairEntry>& list,
                               bool defaultToo = false);

}  // namespace fcl_stpbv
