// Does a robot collide at q? For planners, which ask this far more often than for distances.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fcl_stpbv/robot/checked_pairs.h"
#include "fcl_stpbv/robot/kinematics.h"
#include "fcl_stpbv/robot/link_geometry.h"

namespace fcl_stpbv {

/// A pair that is not known to be clear.
struct Hit {
  int pair = -1;  ///< among pairs(); -1 where q is no configuration, so that nothing is clear
  CheckedPair bodies{-1, -1, false};  ///< the pair's
};

/// What verdicts took: counts of work, which unlike times are the same on any machine.
struct CheckerWork {
  long configurations = 0;  ///< asked about
  long near = 0;            ///< pairs that their spheres did not clear, and that were looked at
  long searched = 0;        ///< of these, pairs that neither balls nor a plane decided
};

/// Decides for a robot's fixed pairs whether any comes within a margin. Clear means proven: a q that is not
/// finite or has another size, and a pair that cannot be measured, as with links 1e160 m away, are not clear.
///
/// Bounding spheres leave few pairs; of these the plane that kept the two bodies apart last time clears most,
/// and a search that stops as soon as its bounds tell decides the others, those first that hit last. What is
/// remembered changes the time only; within rounding of the margin itself it may change the verdict. One
/// thread at a time may use one; copies share the robot and nothing else. No allocation after construction
/// where all bodies are convex.
class CollisionChecker {
 public:
  using ConstVector = Eigen::Ref<const Eigen::VectorXd>;  ///< a configuration

  /// A pair is clear if its distance is above `margin` (m; negative: less deep in each other).
  /// @throws Error for no pairs, a pair that names a body or an obstacle that does not exist, and a margin
  /// that is not a number.
  CollisionChecker(std::shared_ptr<const Kinematics> kinematics,
                   std::shared_ptr<const RobotGeometry> geometry, std::vector<CheckedPair> pairs,
                   std::vector<Obstacle> obstacles = {}, double margin = 0);
  /// Remembers what the other one does.
  CollisionChecker(const CollisionChecker& other);
  CollisionChecker& operator=(const CollisionChecker&) = delete;
  /// Takes over all that the other one has; the other one may only be destroyed.
  CollisionChecker(CollisionChecker&&) noexcept;
  ~CollisionChecker();

  /// The pairs given.
  const std::vector<CheckedPair>& pairs() const;
  /// The robot.
  const Kinematics& kinematics() const;
  /// The names of a pair's bodies. @throws Error for a pair that does not exist, as that of a q that is none.
  std::string name(int pair) const;

  /// The margin (m).
  double margin() const;
  /// Sets it. @throws Error for one that is not a number.
  void setMargin(double margin);

  /// Whether any pair is not known to be clear.
  bool collides(const ConstVector& q);
  /// Such a pair, the first one found; nothing where all are clear.
  std::optional<Hit> firstHit(const ConstVector& q);
  /// All such pairs, ascending; one Hit without a pair where q is no configuration.
  const std::vector<Hit>& allHits(const ConstVector& q);
  /// The least distance of all pairs (m), as CollisionConstraints measures them: signed, at deep overlap a
  /// lower bound. The lowest of all doubles where q is no configuration or a pair cannot be measured.
  double minDistance(const ConstVector& q);

  /// What all verdicts so far took.
  const CheckerWork& work() const;
  /// Forgets all pairs' planes: the next configuration has nothing to do with the last one.
  void forget();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fcl_stpbv
