// Output formats for the result of find_posture.
#pragma once

#include <optional>
#include <string>

#include "fcl_stpbv/posture/collision_rows.h"
#include "fcl_stpbv/posture/find_posture.h"

namespace fcl_stpbv::report {

/// The result of find_posture.
struct PostureReport {
  PostureScene scene;
  PostureTask task;
  std::shared_ptr<const Kinematics> kinematics;
  std::vector<CheckedPair> pairs;
  Posture posture;
  std::optional<detail::NamedDistance> closest;  ///< in the posture; nothing without pairs
  bool ignoresPairs = false;                     ///< the pairs were no constraints
  int colliding = 0;  ///< pairs that are not farther apart than the margin, where they were none
  std::vector<std::string> warnings;
  /// Wrong shapes that were left out; nothing was checked against them.
  std::vector<std::string> skipped;
  /// Result of the same task without any checked pair; no value without pairs.
  std::optional<Posture> withoutCollisions;
};

/// "feasible (converged)"; where the pairs were no constraints, that and how many of them collide.
std::string verdictOf(const PostureReport& report);
/// A violation with its unit: "12.700 mm", "0.0127 rad", or a number.
std::string amountOf(const Violation& violation);
std::string toText(const PostureReport& report);
std::string toJson(const PostureReport& report);
/// The page of a collision report, with the robot in its posture among the obstacles.
std::string toHtml(const PostureReport& report);

}  // namespace fcl_stpbv::report
