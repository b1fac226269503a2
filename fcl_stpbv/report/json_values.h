// Values of the report's JSON.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "fcl_stpbv/robot/kinematics.h"

namespace fcl_stpbv::report {

inline nlohmann::json numbers(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// The value of each coordinate, by its name.
inline nlohmann::json byName(const Eigen::VectorXd& q, const Kinematics& kinematics) {
  nlohmann::json json = nlohmann::json::object();
  for (int i = 0; i < kinematics.size(); ++i) json[kinematics.names()[static_cast<std::size_t>(i)]] = q[i];
  return json;
}

/// A number that is not finite stands for one that is not known.
inline nlohmann::json orNull(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

inline nlohmann::json orNull(const std::string& text) {
  return text.empty() ? nlohmann::json() : nlohmann::json(text);
}

}  // namespace fcl_stpbv::report
