// See named_posture.h.
#include "fcl_stpbv/report/named_posture.h"

#include <cmath>
#include <filesystem>
#include <vector>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/json_text.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

// A configuration from a JSON object of joints' values, or a list of all coordinates.
Eigen::VectorXd poseFromJson(const std::string& path, const Kinematics& kinematics) {
  // A joint value larger than any robot's is a mistake, and past 1e9 its sine has no exact digit left.
  constexpr double kMost = 1e6;
  const auto values = [&](const nlohmann::json& json) {
    const auto list = json.is_array() ? json.get<std::vector<double>>() : std::vector{json.get<double>()};
    for (const double value : list)
      if (!(std::abs(value) <= kMost)) throw Error(path + ": a joint's value must be from -1e6 to 1e6");
    return list;
  };
  try {
    const nlohmann::json json = readJson(path);
    if (json.is_array()) {
      const std::vector<double> all = values(json);
      if (static_cast<int>(all.size()) != kinematics.size())
        throw Error(path + ": has " + std::to_string(all.size()) + " values, the robot has " +
                    std::to_string(kinematics.size()) + " coordinates");
      return Eigen::Map<const Eigen::VectorXd>(all.data(), kinematics.size());
    }
    Srdf::State state;
    state.name = path;
    for (const auto& [joint, value] : json.items()) {
      if (kinematics.robot().joint(joint) < 0) throw Error(path + ": the robot has no joint '" + joint + "'");
      state.joints[joint] = values(value);
    }
    return kinematics.configuration(state);
  } catch (const nlohmann::json::exception& error) {
    throw Error(path + ": expected a JSON object of joints and their values (" + error.what() + ")");
  }
}

}  // namespace

Eigen::VectorXd namedPosture(const std::string& option, const std::string& name, const Kinematics& kinematics,
                             const Srdf* srdf) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(name, ignored)) return poseFromJson(name, kinematics);
  if (!srdf)
    throw Error(option + " " + name +
                ": no such file, and no SRDF with postures; give --srdf or a JSON file");
  return kinematics.configuration(srdf->state(name));
}

}  // namespace fcl_stpbv::report
