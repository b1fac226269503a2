// Which pairs of links can meet at all: MoveIt's reasons for leaving a pair
// out, from samples, descents and proofs.
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
  sometimes,      ///< collides in some configuration, which is given; to be checked
  adjacent,       ///< on either side of one joint
  rigid,          ///< no joint can change where the two are to each other
  byDefault,      ///< collides in the neutral configuration and wherever else it was looked for
  defaultClears,  ///< collides in the neutral configuration and is clear in another; to be checked
  always,         ///< collides in nearly every sample; to be checked. Links are clear in the neutral
                  ///< configuration then, a link and an obstacle need not be
  user,           ///< left out by the user's SRDF
  neverSampled,   ///< no collision in any sample, nor in descents
  neverProven,    ///< no collision within the joint limits
};

/// For people and reports: "never (proven)" and the like.
const char* reasonText(PairReason reason);

/// Whether a pair is checked where no SRDF says so: all but adjacent, rigid, byDefault and user.
bool checkedWithoutSrdf(PairReason reason);

/// How thoroughly pairs are searched.
struct PairListOptions {
  int samples = 2000;      ///< random configurations
  std::uint64_t seed = 1;  ///< of the random configurations
  int descents = 3;        ///< from this many of a pair's closest samples
  int randomDescents =
      500;                ///< from this many random configurations, for a pair found clear so far and not
                          ///< proven; with n > 24 coordinates between the two, (24/n)^2 of them, and in
                          ///< a list of P pairs of a robot of N coordinates, P N > 100,000, 100,000/(P N);
                          ///< at most 50 for a pair that the first proof decides, to find how close it comes
  long proofBoxes = 200;  ///< looked at for each pair found clear so far; likewise, (24/n)^3 of them
  double proofSeconds = 0;  ///< time for further proofs in all; a pair that is not decided then stays sampled
  double margin = 0;        ///< a pair collides if its distance is at most this (m)
  double alwaysFraction = 0.95;     ///< of at least 60 samples in collision, as MoveIt has it
  Eigen::VectorXd neutral;          ///< the neutral configuration; empty for Kinematics::neutral()
  int threads = 1;                  ///< that share the work
  std::vector<Obstacle> obstacles;  ///< each is a pair with each link that joints or the base move
  std::function<void(std::size_t, std::size_t, const std::string&)>
      progress;  ///< called now and then: steps done, of how many, at what
};

/// One pair, and why it is checked or left out.
struct PairEntry : LinkPair {  ///< a pair with an obstacle is never left out as adjacent or by default
  PairReason reason = PairReason::sometimes;
  int samples = 0;          ///< configurations tried
  int collisions = 0;       ///< of these, in collision
  double minDistance = 0;   ///< least found (m); that of the neutral configuration where nothing was sampled
  Eigen::VectorXd closest;  ///< the configuration it was found in
  bool byDescent = false;   ///< found by a descent, not by a sample
  double neutralDistance = 0;  ///< in the neutral configuration (m)
  long boxes = 0;              ///< looked at by proofs
  double security = 0;         ///< distance to keep, proposed for an optimiser or a controller (m)
  double influence = 0;        ///< distance from which the pair counts, likewise (m)

  /// With this confidence, 95 %, a random configuration collides with less than this probability: 3/n where
  /// none of n did.
  double probabilityBound() const { return collisions > 0 || samples == 0 ? 1 : 3.0 / samples; }
};

/// @throws Error naming the robot's file where the pairs of its bodies, and those with so many obstacles, are
/// more than memory (4 GB) holds in the search below.
void requireRoomForPairs(const Kinematics& kinematics, const RobotGeometry& geometry, std::size_t obstacles);

/// All pairs of links that have bodies, then those with obstacles. Deterministic for a seed, but for proofs
/// that `proofSeconds` cuts short.
///
/// `srdf` (or null) gives the user's own entries, of the reason "User" and of enable_collisions; its other
/// entries are found anew. @throws Error as requireRoomForPairs() does.
std::vector<PairEntry> pairList(std::shared_ptr<const Kinematics> kinematics,
                                std::shared_ptr<const RobotGeometry> geometry, const Srdf* srdf,
                                const PairListOptions& options = {});

/// The pairs of bodies that such a list leaves to be checked where there is no SRDF.
std::vector<CheckedPair> checkedPairs(const RobotGeometry& geometry, const std::vector<PairEntry>& list);

/// How many pairs there are of each reason, such as "3 adjacent, 1 rigid".
std::string countsOf(const std::vector<PairEntry>& list);

/// The pairs of links to leave out, sorted by the links' names, for withPairs(). The user's own are not among
/// them. Those that collide in the neutral configuration, or in nearly every sample, and are clear elsewhere
/// only with `defaultToo`. @throws Error for a link that the robot does not have.
std::vector<Srdf::Pair> toSrdf(const RobotModel& robot, const std::vector<PairEntry>& list,
                               bool defaultToo = false);

}  // namespace fcl_stpbv
