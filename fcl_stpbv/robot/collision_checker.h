// Collision check of a robot at a configuration q: a fast yes-or-no answer for planners, which rarely need
// distances.
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
  /// Index into pairs(). -1 if q is not a valid configuration, so that no pair is clear: it has a wrong size,
  /// a value is not finite, or links are so far away that rounding may move them by 1 mm.
  int pair = -1;
  CheckedPair bodies{-1, -1, false};  ///< the bodies of the pair
};

/// Work of all checks so far, as counts. Unlike times they are the same on any machine.
struct CheckerWork {
  long configurations = 0;  ///< number of configurations checked
  long near = 0;            ///< pairs whose bounding spheres did not prove them clear, and that were examined
  long searched = 0;        ///< of these, pairs that neither balls nor a separating plane decided
};

/// Decides whether any pair of a fixed list comes within a margin. A pair is called clear only if that is
/// proven. So nothing is clear at a q that is not finite or has a wrong size, and a pair without a distance
/// (for example with links 1e160 m away) is not clear.
///
/// Bounding spheres leave few pairs. The separating plane of the last check clears most of these. A search
/// decides the rest and stops as soon as its bounds suffice; pairs that collided most recently come first.
/// The cache changes only the time, except for distances within rounding of the margin, where it may change
/// the verdict. Not thread-safe: only one thread at a time may use a checker; copies share only the robot. No
/// allocation after construction if all bodies are convex.
class CollisionChecker {
 public:
  using ConstVector = Eigen::Ref<const Eigen::VectorXd>;  ///< a configuration

  /// A pair is clear if its signed distance is above `margin` (m). A negative margin allows that depth of
  /// overlap.
  /// @throws Error for no pairs, a pair that names a body or an obstacle that does not exist, and a margin
  /// that is not a number.
  CollisionChecker(std::shared_ptr<const Kinematics> kinematics,
                   std::shared_ptr<const RobotGeometry> geometry, std::vector<CheckedPair> pairs,
                   std::vector<Obstacle> obstacles = {}, double margin = 0);
  /// Copies the caches too.
  CollisionChecker(const CollisionChecker& other);
  CollisionChecker& operator=(const CollisionChecker&) = delete;
  /// Moves the contents of another object, which may only be destroyed or assigned to afterwards.
  CollisionChecker(CollisionChecker&&) noexcept;
  /// The same.
  CollisionChecker& operator=(CollisionChecker&&) noexcept;
  ~CollisionChecker();

  /// The pairs given.
  const std::vector<CheckedPair>& pairs() const;
  /// The robot.
  const Kinematics& kinematics() const;
  /// The names of a pair's bodies, for the index in any Hit: for its -1, a text that says that q is not a
  /// valid configuration. @throws Error for other indices that do not exist.
  std::string name(int pair) const;

  /// The margin (m).
  double margin() const;
  /// Sets the margin (m). @throws Error for a value that is not a number.
  void setMargin(double margin);

  /// Whether any pair is not known to be clear.
  bool collides(const ConstVector& q);
  /// A pair that is not known to be clear: the first one found. No value if all pairs are clear. A Hit with
  /// pair -1 if q is not a valid configuration.
  std::optional<Hit> firstHit(const ConstVector& q);
  /// All pairs that are not known to be clear, in ascending order. A single Hit with pair -1 if q is not a
  /// valid configuration.
  const std::vector<Hit>& allHits(const ConstVector& q);
  /// The least signed distance of all pairs (m), as in CollisionConstraints; for deep overlap it is a lower
  /// bound. The lowest double if q is not a valid configuration or a pair has no distance.
  double minDistance(const ConstVector& q);

  /// The work of all checks so far.
  const CheckerWork& work() const;
  /// Drops the separating planes of all pairs. Call it if the next configuration is unrelated to the last
  /// one.
  void forget();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fcl_stpbv
