// Reads an SRDF: pairs to leave out, group states, virtual joints. Entries that name no link or joint of the
// robot are warnings.
#include "fcl_stpbv/robot/srdf.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <unordered_set>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/mesh_lines.h"
#include "fcl_stpbv/mesh/xml_text.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/near_name.h"
#include "fcl_stpbv/robot/srdf_reason.h"
#include "fcl_stpbv/words.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using tinyxml2::XMLElement;

// All elements of SRDF. take() reads some of them.
constexpr Words kOthers{"group",
                        "end_effector",
                        "passive_joint",
                        "joint_property",
                        "link_sphere_approximation",
                        "chain",
                        "group_state",
                        "virtual_joint",
                        "disable_default_collisions",
                        "enable_collisions",
                        "disable_collisions"};

// The elements that take() reads.
constexpr Words kRead{"group_state", "virtual_joint", "disable_default_collisions", "enable_collisions",
                      "disable_collisions"};

class SrdfReader {
 public:
  SrdfReader(const std::string& path, const RobotModel& robot, LoadFaults& faults)
      : path_(path), robot_(robot), faults_(faults) {
    for (const LinkModel& link : robot.links) links_.insert(link.name);
  }

  Srdf read() {
    tinyxml2::XMLDocument document;
    srdf_.path = path_;
    srdf_.text = readXml(path_);
    parseXml(srdf_.text, path_, document);
    const XMLElement& root = *document.RootElement();
    if (std::string_view(root.Name()) != "robot")
      throw Error(xmlPlace(root, path_) + "its root element is <" + root.Name() + ">, expected <robot>");
    if (root.FirstChildElement("link") && root.FirstChildElement("joint"))
      throw Error(path_ + ": is a URDF, with <link> and <joint>; give the robot's SRDF");
    const char* name = root.Attribute("name");
    if (name && name != robot_.name)
      warn(root, std::string("is of the robot '") + name + "', used for '" + robot_.name + "'");
    for (const XMLElement* e = root.FirstChildElement(); e; e = e->NextSiblingElement())
      LoadFaults::gather(faults_.errors, [&] { take(*e); });
    for (const Srdf::State& state : srdf_.states) warnOfUnknown(state);
    return std::move(srdf_);
  }

 private:
  void take(const XMLElement& e) {
    const std::string_view name = e.Name();
    if (name == "disable_collisions") addPair(e, srdf_.disabled);
    if (name == "enable_collisions") addPair(e, srdf_.enabled);
    if (name == "disable_default_collisions" && known(e, "link"))
      srdf_.defaultsOff.push_back(e.Attribute("link"));
    if (name == "group_state") srdf_.states.push_back(state(e));
    if (name == "virtual_joint") addVirtualJoint(e);
    if (!holds(kOthers, name) && name.find(':') == std::string_view::npos) warnOfOther(e, namesPair(e));
    warnOfInner(e);
  }

  static bool namesPair(const XMLElement& e) { return e.Attribute("link1") || e.Attribute("link2"); }

  void warnOfOther(const XMLElement& e, bool pair) {
    warn(e, "<" + std::string(e.Name()) + "> is no element of SRDF and is ignored" +
                (pair ? "; is it a misspelt <disable_collisions>?" : ""));
  }

  // Warns of elements that take() would read, or that may be meant as such, within another element.
  void warnOfInner(const XMLElement& around) {
    for (const XMLElement* e = around.FirstChildElement(); e; e = e->NextSiblingElement()) {
      if (holds(kRead, e->Name()))
        warn(*e, "<" + std::string(e->Name()) + "> within <" + around.Name() +
                     "> is ignored; it belongs directly into <robot>");
      else if (namesPair(*e))
        warnOfOther(*e, true);
      warnOfInner(*e);
    }
  }

  void warn(const XMLElement& e, const std::string& message) {
    srdf_.warnings.push_back(xmlPlace(e, path_) + message);
  }

  // This is only a warning, because a state may belong to a variant of the robot, for example one with a
  // gripper.
  void warnOfUnknown(const Srdf::State& state) {
    std::string list;
    for (const auto& [joint, values] : state.joints) {
      if (robot_.joint(joint) >= 0 || virtual_.count(joint) > 0) continue;
      const std::string near = proposals_.near(joint, [&] { return namesOf(robot_.joints); });
      list += (list.empty() ? "'" : ", '") + joint + "'" +
              (near.empty() ? "" : " (did you mean '" + near + "'?)");
    }
    if (list.empty()) return;
    srdf_.warnings.push_back(path_ + ": the group_state '" + state.name +
                             "' counts without joints that the robot does not have: " + list + ".");
  }

  bool known(const XMLElement& e, const char* attribute) {
    const std::string name = requiredAttribute(e, attribute, path_);
    if (links_.count(name)) return true;
    warn(e, "<" + std::string(e.Name()) + "> is ignored, as the robot has no link '" + name + "'" +
                proposals_.of(name, [&] { return namesOf(robot_.links); }));
    return false;
  }

  void addPair(const XMLElement& e, std::vector<Srdf::Pair>& pairs) {
    const bool first = known(e, "link1"), second = known(e, "link2");
    const char* reason = e.Attribute("reason");
    if (first && second)
      pairs.push_back({e.Attribute("link1"), e.Attribute("link2"), usualReason(reason ? reason : "")});
  }

  // Whether the link is the root, or rigidly joined to it.
  bool ofRoot(const std::string& name) const {
    int link = robot_.link(name);
    while (link > 0) {
      const JointModel& joint = robot_.joints[at(robot_.links[at(link)].parentJoint)];
      if (joint.type != JointType::fixed) return false;
      link = joint.parent;
    }
    return link == 0;
  }

  // The first virtual joint that carries the root link moves the base, as in MoveIt.
  void addVirtualJoint(const XMLElement& e) {
    const std::string name = requiredAttribute(e, "name", path_), type = requiredAttribute(e, "type", path_);
    const char* child = e.Attribute("child_link");
    virtual_.insert(name);
    if (type != "fixed" && type != "planar" && type != "floating")
      throw Error(xmlPlace(e, path_) + "the virtual_joint '" + name + "' is of type '" + type +
                  "'; SRDF knows fixed, planar, floating");
    if (child && !ofRoot(child)) {
      warn(e, "the virtual_joint '" + name + "' is ignored, as its child_link '" + child +
                  "' is not the root link '" + robot_.links.front().name + "' nor fixed to it");
    } else if (!srdf_.baseJoint.empty()) {
      warn(e,
           "the virtual_joint '" + name + "' is ignored, as '" + srdf_.baseJoint + "' carries the root link");
    } else {
      srdf_.baseJoint = name;
      srdf_.baseType = type;
    }
  }

  Srdf::State state(const XMLElement& e) {
    Srdf::State state;
    state.name = requiredAttribute(e, "name", path_);
    if (const char* group = e.Attribute("group")) state.group = group;
    for (const XMLElement* j = e.FirstChildElement(); j; j = j->NextSiblingElement()) {
      if (std::string_view(j->Name()) != "joint") {
        warn(*j, "<" + std::string(j->Name()) + "> is ignored in a <group_state>, expected <joint>");
        continue;
      }
      const std::string value = requiredAttribute(*j, "value", path_);
      const MeshWords words = wordsOf(value);
      const std::string name = requiredAttribute(*j, "name", path_);
      const auto [place, isNew] = state.joints.try_emplace(name);
      if (!isNew)
        throw Error(xmlPlace(*j, path_) + "the group_state '" + state.name + "' names the joint '" + name +
                    "' twice; leave one of them out");
      std::vector<double>& list = place->second;
      for (const std::string_view word : words)
        if (double number; readMeshNumber(word, number)) list.push_back(number);
      if (list.empty() || list.size() != words.size())
        throw Error(xmlPlace(*j, path_) + "a joint's value must be finite numbers");
    }
    return state;
  }

  const std::string& path_;
  const RobotModel& robot_;
  LoadFaults& faults_;
  std::unordered_set<std::string> links_;
  std::set<std::string> virtual_;
  FirstProposals proposals_;
  Srdf srdf_;
};

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// Adds the joints of another state with the same name. @returns the first joint for which the two differ, or
/// "".
std::string takeJoints(Srdf::State& all, const Srdf::State& state) {
  for (const auto& [joint, values] : state.joints)
    if (all.joints.emplace(joint, values).first->second != values) return joint;
  return "";
}

}  // namespace

std::string detail::usualReason(std::string_view reason) {
  while (!reason.empty() && isBlank(reason.front())) reason.remove_prefix(1);
  while (!reason.empty() && isBlank(reason.back())) reason.remove_suffix(1);
  if (reason.empty()) return "User";
  const std::string small = inSmallLetters(reason);
  for (const char* usual : {"User", "Never", "Adjacent", "Always", "Default"})
    if (small == inSmallLetters(usual)) return usual;
  return std::string(reason);
}

SkipReasons::SkipReasons(const Srdf* srdf) {
  if (!srdf) return;
  off_.insert(srdf->defaultsOff.begin(), srdf->defaultsOff.end());
  for (const Srdf::Pair& pair : srdf->enabled) named_.emplace(std::minmax(pair.link1, pair.link2), "");
  for (const Srdf::Pair& pair : srdf->disabled)  // emplace() does not replace: the first entry counts
    named_.emplace(std::minmax(pair.link1, pair.link2), pair.reason);
}

std::string SkipReasons::of(const std::string& link1, const std::string& link2) const {
  const auto named = named_.find(std::minmax(link1, link2));
  if (named != named_.end()) return named->second;
  return off_.count(link1) + off_.count(link2) > 0 ? "User" : "";
}

Srdf::State Srdf::state(const std::string& name) const {
  std::optional<State> found;
  for (const State& state : states) {
    if (state.name != name) continue;
    if (!found) found = State{name, state.group, {}};
    if (const std::string joint = takeJoints(*found, state); !joint.empty())
      throw Error(path + ": several group_states are named '" + name + "' and differ in the joint '" + joint +
                  "'; give one of them another name");
  }
  if (found) return *found;
  std::string known;
  for (const State& state : states) known += (known.empty() ? "" : ", ") + state.name;
  throw Error(path + ": no group_state is named '" + name + "'; " +
              (known.empty() ? "it has none" : "there are: " + known) + didYouMean(name, namesOf(states)));
}

std::vector<Srdf::State> Srdf::allStates() const {
  std::vector<State> all;
  std::map<std::string, std::size_t> place;
  std::set<std::string> differing;
  for (const State& state : states) {
    const auto [known, isNew] = place.emplace(state.name, all.size());
    if (isNew) all.push_back(state);
    if (!takeJoints(all[known->second], state).empty()) differing.insert(state.name);
  }
  all.erase(std::remove_if(all.begin(), all.end(),
                           [&](const State& state) { return differing.count(state.name) > 0; }),
            all.end());
  return all;
}

bool Srdf::movesBase(const State& state) const {
  const auto base = state.joints.find(baseJoint);
  if (base == state.joints.end()) return false;
  // x, y and angle, or x, y, z and a quaternion, whose w gives no additional information.
  const std::vector<double>& values = base->second;
  const auto counts = static_cast<std::ptrdiff_t>(values.size() == 7 ? 6 : values.size());
  return std::any_of(values.begin(), values.begin() + counts,
                     [](double value) { return std::abs(value) > 1e-9; });
}

Srdf loadSrdf(const std::string& path, const RobotModel& robot, LoadFaults& faults) {
  return SrdfReader(path, robot, faults).read();
}

Srdf loadSrdf(const std::string& path, const RobotModel& robot) {
  LoadFaults faults;
  Srdf srdf = loadSrdf(path, robot, faults);
  faults.refuse();
  return srdf;
}

}  // namespace fcl_stpbv
