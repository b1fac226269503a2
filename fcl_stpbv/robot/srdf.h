// Reads and writes SRDF files: pairs that are not checked, named postures, and how the base moves.
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
  /// A pair of links and the reason that the file gives.
  struct Pair {
    std::string link1;   ///< by name
    std::string link2;   ///< by name
    std::string reason;  ///< in MoveIt's spelling if it is one of its words; "User" without one
  };
  /// A named posture of a group of joints.
  struct State {
    std::string name;                                   ///< name of the state
    std::string group;                                  ///< name of the group of joints
    std::map<std::string, std::vector<double>> joints;  ///< values of each joint, by name (rad or m)
  };
  std::string path;  ///< path of the file
  /// The whole file as it was read (kept because a pipe can be read only once).
  std::string text;
  std::vector<Pair> disabled;  ///< disable_collisions
  std::vector<Pair> enabled;   ///< enable_collisions; these override `disabled`
  /// disable_default_collisions: links that are checked only in enabled pairs.
  std::vector<std::string> defaultsOff;
  std::vector<State> states;  ///< group_state
  std::string baseJoint;      ///< name of the virtual_joint of the root link, "" without one
  std::string baseType;       ///< its type
  /// Whole sentences for the user. They are about entries for links that the robot does not have (ignored, as
  /// in MoveIt), about unknown elements, and about a robot name that does not match.
  std::vector<std::string> warnings;

  /// The posture of this name. If several groups have a state of this name, they are combined. @throws Error
  /// listing the existing states, if there is none of this name; or naming a joint for which the combined
  /// states differ.
  State state(const std::string& name) const;
  /// The postures of all names, in the order of the file. Names whose states contradict each other are left
  /// out.
  std::vector<State> allStates() const;
  /// Whether the state moves the root link: it gives the virtual joint values that are not zero motion.
  bool movesBase(const State& state) const;
};

/// Fast lookup of the reason why an SRDF leaves out a pair of links. It keeps the SRDF's contents at
/// construction.
class SkipReasons {
 public:
  /// Takes O(n log n) for n entries. `srdf` may be null; then no pair is left out.
  explicit SkipReasons(const Srdf* srdf);

  /// The reason why the pair is left out; "" if it must be checked. The order of the links does not matter.
  std::string of(const std::string& link1, const std::string& link2) const;

 private:
  std::map<std::pair<std::string, std::string>, std::string> named_;  // with the two names in ascending order
  std::set<std::string> off_;
};

/// Reads an SRDF for `robot`. @throws Error listing everything that is wrong, with line numbers.
Srdf loadSrdf(const std::string& path, const RobotModel& robot);
/// loadSrdf() that adds faults to `faults`, and the caller decides.
Srdf loadSrdf(const std::string& path, const RobotModel& robot, LoadFaults& faults);

/// The text of the SRDF at `path` (of an empty one if `path` is ""), with its disable_collisions entries
/// replaced by `pairs`. Entries with the reason "User" or without a reason stay, and so does every other
/// byte. Entries of `pairs` that the SRDF enables by name, or that these entries leave out, are not written.
/// `comments` are written before the new entries. @throws Error as loadSrdf() does, for a file that is not an
/// SRDF.
std::string withPairs(const std::string& path, const std::string& robotName,
                      const std::vector<Srdf::Pair>& pairs, const std::vector<std::string>& comments = {});
/// withPairs() for an SRDF that was read already; null for an empty one. Entries that loadSrdf() ignored,
/// because the robot has no such link, stay too.
std::string withPairs(const Srdf* srdf, const std::string& robotName, const std::vector<Srdf::Pair>& pairs,
                      const std::vector<std::string>& comments = {});

}  // namespace fcl_stpbv
