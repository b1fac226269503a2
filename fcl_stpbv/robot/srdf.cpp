// See srdf.h.
#include "fcl_stpbv/robot/srdf.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <unordered_set>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/xml_text.h"

namespace fcl_stpbv {
namespace {

using tinyxml2::XMLElement;

class Reader {
 public:
  Reader(const std::string& path, const RobotModel& robot) : path_(path) {
    for (const LinkModel& link : robot.links) links_.insert(link.name);
    for (const JointModel& joint : robot.joints) joints_.insert(joint.name);
  }

  Srdf read() {
    tinyxml2::XMLDocument document;
    loadXml(path_, document);
    Srdf srdf;
    srdf.path = path_;
    for (const XMLElement* e = document.RootElement()->FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string_view name = e->Name();
      if (name == "disable_collisions") srdf.disabled.push_back(pair(*e));
      if (name == "enable_collisions") srdf.enabled.push_back(pair(*e));
      if (name == "disable_default_collisions") srdf.defaultsOff.push_back(link(*e, "link"));
      if (name == "group_state") srdf.states.push_back(state(*e));
      if (name == "virtual_joint") {
        srdf.baseJoint = requiredAttribute(*e, "name", path_);
        srdf.baseType = requiredAttribute(*e, "type", path_);
      }
    }
    return srdf;
  }

 private:
  [[noreturn]] void fail(const XMLElement& e, const std::string& message) const {
    throw Error(path_ + ":" + std::to_string(e.GetLineNum()) + ": " + message);
  }

  std::string link(const XMLElement& e, const char* attribute) const {
    std::string name = requiredAttribute(e, attribute, path_);
    if (!links_.count(name)) fail(e, "the robot has no link '" + name + "'; is this another robot's SRDF?");
    return name;
  }

  Srdf::Pair pair(const XMLElement& e) const {
    const char* reason = e.Attribute("reason");
    return {link(e, "link1"), link(e, "link2"), reason && *reason ? reason : "User"};
  }

  Srdf::State state(const XMLElement& e) const {
    Srdf::State state;
    state.name = requiredAttribute(e, "name", path_);
    if (const char* group = e.Attribute("group")) state.group = group;
    for (const XMLElement* j = e.FirstChildElement("joint"); j; j = j->NextSiblingElement("joint")) {
      std::istringstream values(requiredAttribute(*j, "value", path_));
      values.imbue(std::locale::classic());
      std::vector<double>& list = state.joints[requiredAttribute(*j, "name", path_)];
      for (double value; values >> value;) list.push_back(value);
      const bool finite = std::all_of(list.begin(), list.end(), [](double v) { return std::isfinite(v); });
      if (list.empty() || !finite || !values.eof()) fail(*j, "a joint's value must be finite numbers");
    }
    return state;
  }

  std::string path_;
  std::unordered_set<std::string> links_, joints_;
};

bool same(const Srdf::Pair& pair, const std::string& a, const std::string& b) {
  return (pair.link1 == a && pair.link2 == b) || (pair.link1 == b && pair.link2 == a);
}

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::string Srdf::reasonToSkip(const std::string& link1, const std::string& link2) const {
  const auto matches = [&](const Pair& pair) { return same(pair, link1, link2); };
  if (std::any_of(enabled.begin(), enabled.end(), matches)) return "";
  const auto found = std::find_if(disabled.begin(), disabled.end(), matches);
  if (found != disabled.end()) return found->reason;
  return holds(defaultsOff, link1) || holds(defaultsOff, link2) ? "User" : "";
}

const Srdf::State& Srdf::state(const std::string& name) const {
  std::string known;
  for (const State& state : states) {
    if (state.name == name) return state;
    known += (known.empty() ? "" : ", ") + state.name;
  }
  throw Error(path + ": no group_state is named '" + name + "'; " +
              (known.empty() ? "it has none" : "there are: " + known));
}

Srdf loadSrdf(const std::string& path, const RobotModel& robot) { return Reader(path, robot).read(); }

std::string withPairs(const std::string& path, const std::string& robotName,
                      const std::vector<Srdf::Pair>& pairs) {
  tinyxml2::XMLDocument document;
  if (path.empty()) {
    document.InsertEndChild(document.NewDeclaration());
    XMLElement* root = document.NewElement("robot");
    root->SetAttribute("name", robotName.c_str());
    document.InsertEndChild(root);
  } else {
    loadXml(path, document);
  }
  XMLElement* root = document.RootElement();
  for (XMLElement* e = root->FirstChildElement("disable_collisions"); e;) {
    XMLElement* next = e->NextSiblingElement("disable_collisions");
    const char* reason = e->Attribute("reason");
    if (reason && std::string_view(reason) != "User") root->DeleteChild(e);
    e = next;
  }
  for (const Srdf::Pair& pair : pairs) {
    XMLElement* e = document.NewElement("disable_collisions");
    e->SetAttribute("link1", pair.link1.c_str());
    e->SetAttribute("link2", pair.link2.c_str());
    e->SetAttribute("reason", pair.reason.c_str());
    root->InsertEndChild(e);
  }
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

}  // namespace fcl_stpbv
