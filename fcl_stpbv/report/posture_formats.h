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
  std::optional<detail::NamedDistance> closest;  ///< closest pair in the posture; no value without pairs
  std::vector<std::string> warnings;
  /// Wrong shapes that were left out; nothing was checked against them.
  std::vector<std::string> skipped;
  /// Result of the same task without any checked pair; no value without pairs.
  std::optional<Posture> withoutCollisions;
};

std::string toText(const PostureReport& report);
std::string toJson(const PostureReport& report);
/// The page of a collision report, with the robot in its posture among the obstacles.
std::string toHtml(const PostureReport& report);

}  // namespace fcl_stpbv::report
