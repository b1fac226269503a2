// A posture from a group state of the SRDF, else from a JSON file: values by joint, all coordinates in a
// list, an answer of find_posture, or the posture that a report proposes. Joints that it leaves out stay as
// they are.
#include "fcl_stpbv/report/named_posture.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/mesh/json_text.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/joint_names.h"
#include "fcl_stpbv/robot/near_name.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

constexpr const char* kBaseStays =
    "but the obstacles are seen from the robot's root link; give obstacles placed so that the base stays at "
    "the origin, and ";

/// The keys that a report's and an answer's JSON have (report_json.cpp, posture_formats.cpp).
const std::vector<std::string> kOfReport{"robot",   "pose",  "neutral", "trajectory", "warnings",
                                         "skipped", "links", "pairs",   "summary"};
const std::vector<std::string> kOfNeutral{"colliding", "better", "better_state", "better_colliding"};
const std::vector<std::string> kOfAnswer{
    "feasible",          "status",  "seconds",    "iterations", "starts",   "distance_calls",
    "gradient_calls",    "pairs",   "parts",      "cost",       "q",        "closest",
    "warnings",          "skipped", "violations", "active",     "conflict", "conflict_limits",
    "without_collisions"};

/// Refuses other keys beside the posture, because a joint's value there would have no effect.
void refuseBeside(const std::string& where, const nlohmann::json& json, const std::vector<std::string>& keys,
                  const std::string& whose) {
  for (const auto& [key, value] : json.items()) {
    (void)value;
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    const std::string near = didYouMean(key, keys);
    throw Error(where + ": '" + key + "' is no key of " + whose +
                (near.empty() ? "; remove it, or give a file of joints' values alone" : near));
  }
}

/// The joints of an answer of find_posture, its member `q`. The base's pose in `q` matters only to obstacles.
nlohmann::json jointsOfAnswer(const std::string& path, const nlohmann::json& q, const Kinematics& kinematics,
                              bool obstacles) {
  const std::vector<std::string>& own = kinematics.names();
  nlohmann::json joints = nlohmann::json::object();
  for (const auto& [name, value] : q.items()) {
    if (name.rfind("base/", 0) != 0 || std::find(own.begin(), own.end(), name) != own.end())
      joints[name] = value;
    else if (obstacles)
      throw Error(path + ": places the base ('" + name + "'), " + kBaseStays + "the values of joints alone");
  }
  return joints;
}

// The posture that a collision report proposes in its member `neutral`.
nlohmann::json betterOfReport(const std::string& path, const nlohmann::json& neutral) {
  refuseBeside(path + ": neutral", neutral, kOfNeutral, "what a collision report says of it");
  if (!neutral.contains("better"))
    throw Error(path +
                ": is a collision report that proposes no neutral posture; give a file of joints' values");
  if (!neutral["better"].is_object() && !neutral["better"].is_array())
    throw Error(path + ": neutral.better is neither an object of joints' values nor a list of all");
  return neutral["better"];
}

// A configuration from a JSON object of joints' or coordinates' values, or a list of all coordinates.
Eigen::VectorXd poseFromJson(const std::string& path, const Kinematics& kinematics, Eigen::VectorXd rest,
                             bool obstacles) {
  // Largest value of a joint. A larger one than any robot's is a mistake, and past 1e9 its sine has no exact
  // digit left.
  constexpr double kMost = 1e6;
  const auto values = [&](const nlohmann::json& json) {
    const auto list = json.is_array() ? json.get<std::vector<double>>() : std::vector{json.get<double>()};
    for (const double value : list)
      if (!(std::abs(value) <= kMost)) throw Error(path + ": a joint's value must be from -1e6 to 1e6");
    return list;
  };
  try {
    nlohmann::json json = readJson(path);
    const auto holds = [&](const char* key) {
      return json.is_object() && json.contains(key) && json[key].is_object();
    };
    if (holds("q")) {
      refuseBeside(path, json, kOfAnswer, "an answer of find_posture");
      json = jointsOfAnswer(path, json["q"], kinematics, obstacles);
    } else if (holds("neutral")) {
      refuseBeside(path, json, kOfReport, "a collision report");
      json = betterOfReport(path, json["neutral"]);
    }
    if (json.is_array()) {
      const std::vector<double> all = values(json);
      if (static_cast<int>(all.size()) != kinematics.size())
        throw Error(path + ": has " + std::to_string(all.size()) + " values, the robot has " +
                    std::to_string(kinematics.size()) + " coordinates");
      return Eigen::Map<const Eigen::VectorXd>(all.data(), kinematics.size());
    }
    Srdf::State state;
    state.name = path;
    const std::vector<std::string>& coordinates = kinematics.names();
    for (const auto& [name, value] : json.items()) {
      if (kinematics.robot().joint(name) >= 0) {
        state.joints[name] = values(value);
        continue;
      }
      const auto own = std::find(coordinates.begin(), coordinates.end(), name);
      if (own == coordinates.end()) {
        std::vector<std::string> known = valueNames(kinematics);
        if (value.is_object()) known.insert(known.end(), {"q", "neutral"});
        throw Error(path + ": the robot has no joint '" + name + "'" + didYouMean(name, known));
      }
      const std::string joint = name.substr(0, name.rfind('/'));
      if (json.contains(joint)) throw Error(path + ": names '" + joint + "' and '" + name + "'; give one");
      const std::vector<double> single = values(value);
      if (single.size() != 1) throw Error(path + ": '" + name + "' is one number");
      rest[own - coordinates.begin()] = single.front();
    }
    return kinematics.configuration(state, rest);
  } catch (const nlohmann::json::exception& error) {
    throw Error(path + ": expected a JSON object of joints and their values (" + error.what() + ")");
  }
}

}  // namespace

Eigen::VectorXd namedPosture(const std::string& option, const std::string& name, const Kinematics& kinematics,
                             const Srdf* srdf, const Eigen::VectorXd& rest, bool obstacles) {
  std::error_code ignored;
  const bool isFile = name == "-" || (std::filesystem::exists(name, ignored) &&
                                      !std::filesystem::is_directory(name, ignored));
  const bool isState = srdf && std::any_of(srdf->states.begin(), srdf->states.end(),
                                           [&](const Srdf::State& state) { return state.name == name; });
  if (isFile && isState)
    throw Error(option + " " + name + ": is a state of the SRDF and a file; give ./" + name +
                " for the file, or rename it");
  if (isFile) return poseFromJson(name, kinematics, rest, obstacles);  // also a pipe
  if (!srdf)
    throw Error(option + " " + name +
                ": no such file, and no SRDF with postures; give --srdf or a JSON file");
  const Srdf::State state = srdf->state(name);
  if (obstacles && srdf->movesBase(state))
    throw Error(option + " " + name + ": places the base by the virtual joint '" + srdf->baseJoint + "', " +
                kBaseStays + "a posture without that joint");
  return kinematics.configuration(state, rest);
}

std::string limitWarning(const std::string& name, const std::vector<Eigen::VectorXd>& postures,
                         const Kinematics& kinematics, const std::string& consequence) {
  constexpr double kOff = 1e-6;  // error of a rounded number (rad or m)
  std::string first;
  int more = -1;
  for (const JointModel& joint : kinematics.robot().joints) {
    if (joint.type != JointType::revolute && joint.type != JointType::prismatic) continue;
    const JointModel& leader = joint.mimic ? kinematics.robot().joints[at(joint.mimic->joint)] : joint;
    const int k = kinematics.coordinate(leader.name);
    const auto valueIn = [&](const Eigen::VectorXd& q) {
      return joint.mimic ? joint.mimic->multiplier * q[k] + joint.mimic->offset : q[k];
    };
    const auto outside = std::find_if(postures.begin(), postures.end(), [&](const Eigen::VectorXd& q) {
      return !(valueIn(q) >= joint.lower - kOff && valueIn(q) <= joint.upper + kOff);
    });
    if (outside == postures.end() || ++more > 0) continue;
    const char* unit = joint.type == JointType::revolute ? " rad" : " m";
    first = name + ": " +
            (postures.size() > 1 ? "way point " + std::to_string(outside - postures.begin()) + " (from 0): "
                                 : "") +
            "the joint '" + joint.name + "' is at " + toDecimal(valueIn(*outside)) + unit +
            ", outside of its limits " + toDecimal(joint.lower) + " to " + toDecimal(joint.upper) + unit;
  }
  if (more > 0)
    first += ", and " + std::to_string(more) +
             (more == 1 ? " other joint leaves its" : " other joints leave theirs");
  return first.empty() ? "" : first + "; " + consequence + ".";
}

}  // namespace fcl_stpbv::report
