// What an SRDF adds to a URDF: pairs not to check, named postures, how the base moves.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv {

struct Srdf {
  struct Pair {
    std::string link1, link2, reason;
  };
  struct State {
    std::string name, group;
    std::map<std::string, std::vector<double>> joints;
  };
  std::string path;
  std::vector<Pair> disabled;            ///< disable_collisions
  std::vector<Pair> enabled;             ///< enable_collisions; these win
  std::vector<std::string> defaultsOff;  ///< disable_default_collisions: links checked only where enabled
  std::vector<State> states;             ///< group_state
  std::string baseJoint, baseType;       ///< virtual_joint, "" without one

  /// Whether the pair is to be left out, and why; "" where it is to be checked.
  std::string reasonToSkip(const std::string& link1, const std::string& link2) const;
  /// @throws Error naming the states there are.
  const State& state(const std::string& name) const;
};

/// Reads an SRDF; names must exist in `robot`. @throws Error naming the file and the line.
Srdf loadSrdf(const std::string& path, const RobotModel& robot);

/// The SRDF at `path` (a bare one where `path` is "") with its disable_collisions replaced by `pairs`.
/// Entries of the reason "User" and everything else stay as they are.
std::string withPairs(const std::string& path, const std::string& robotName,
                      const std::vector<Srdf::Pair>& pairs);

}  // namespace fcl_stpbv
