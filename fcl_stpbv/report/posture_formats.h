// Output formats for the result of find_posture.
#pragma once

#include <optional>
#include <string>

#include "fcl_stpbv/posture/collision_rows.h"
#include "fcl_stpbv/posture/find_posture.h"

namespace fcl_stpbv::report {

/// What find_posture found out.
struct PostureReport {
  PostureScene scene;
  PostureTask task;
  std::shared_ptr<const Kinematics> kinematics;
  std::vector<CheckedPair> pairs;
  Posture posture;
  std::optional<detail::NamedDistance> closest;  ///< in the posture; nothing without pairs
  std::vector<std::string> warnings;
  std::vector<std::string> skipped;          ///< shapes left out as wrong, which nothing was checked against
  std::optional<Posture> withoutCollisions;  ///< the same task with no pair checked, where there are pairs
};

std::string toText(const PostureReport& report);
std::string toJson(const PostureReport& report);
/// The page of a collision report, with the robot in its posture among the obstacles.
std::string toHtml(const PostureReport& report);

}  // namespace fcl_stpbv::report
