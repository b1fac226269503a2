// What an SRDF adds to a URDF: pairs not to check, named postures, how the base moves.
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv {

/// An SRDF's contents.
struct Srdf {
  /// Two links and what the file says of them.
  struct Pair {
    std::string link1;   ///< by name
    std::string link2;   ///< by name
    std::string reason;  ///< "" without one
  };
  /// A named posture of a group of joints.
  struct State {
    std::string name;                                   ///< of the state
    std::string group;                                  ///< of joints
    std::map<std::string, std::vector<double>> joints;  ///< values by joint (rad or m)
  };
  std::string path;                      ///< of the file
  std::string text;                      ///< all of it as it was read; a pipe can be read only once
  std::vector<Pair> disabled;            ///< disable_collisions
  std::vector<Pair> enabled;             ///< enable_collisions; these win
  std::vector<std::string> defaultsOff;  ///< disable_default_collisions: links checked only where enabled
  std::vector<State> states;             ///< group_state
  std::string baseJoint;                 ///< the virtual_joint that carries the root link, "" without one
  std::string baseType;                  ///< its type
  /// Whole sentences, to be told to the user: entries for links that the robot does not have, which count for
  /// nothing as in MoveIt; elements that SRDF does not know; the name of another robot.
  std::vector<std::string> warnings;

  /// The posture of this name; of several groups together, where each has a state of the name.
  /// @throws Error naming the states there are, or a joint in which states of the name differ.
  State state(const std::string& name) const;
  /// Those of all names, in the order that the file first has them; without names whose states differ.
  std::vector<State> allStates() const;
  /// Whether the state puts the root link elsewhere, by other values of the virtual joint than those of no
  /// motion.
  bool movesBase(const State& state) const;
};

/// What an SRDF says of any two links, as it was when this was made. Finds one pair among many at once.
class SkipReasons {
 public:
  /// O(n log n) for n entries; null for no SRDF, which leaves nothing out.
  explicit SkipReasons(const Srdf* srdf);

  /// Why the pair is to be left out; "" where it is to be checked. The order of the links is no matter.
  std::string of(const std::string& link1, const std::string& link2) const;

 private:
  std::map<std::pair<std::string, std::string>, std::string> named_;  // names ascending
  std::set<std::string> off_;
};

/// Reads an SRDF for `robot`. @throws Error listing all that is wrong, each with its line.
Srdf loadSrdf(const std::string& path, const RobotModel& robot);
/// The same, but what is wrong is added to `faults` for the caller to refuse.
Srdf loadSrdf(const std::string& path, const RobotModel& robot, LoadFaults& faults);

/// The SRDF at `path` (a bare one where `path` is "") with its disable_collisions replaced by `pairs`.
/// Entries of the reason "User" or of none and everything else stay as they are; pairs that the SRDF enables
/// by name are left out of `pairs`. Each of `comments` goes before them. @throws Error as loadSrdf() for a
/// file that is none.
std::string withPairs(const std::string& path, const std::string& robotName,
                      const std::vector<Srdf::Pair>& pairs, const std::vector<std::string>& comments = {});
/// The same of an SRDF as it was read, a bare one for null.
std::string withPairs(const Srdf* srdf, const std::string& robotName, const std::vector<Srdf::Pair>& pairs,
                      const std::vector<std::string>& comments = {});

}  // namespace fcl_stpbv
