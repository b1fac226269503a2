// The tree of links and joints that a URDF's elements form, by their names.
#pragma once

#include <tinyxml2.h>

#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv::detail {

struct UrdfTree {
  std::vector<const tinyxml2::XMLElement*> links;   ///< parents before their children
  std::vector<const tinyxml2::XMLElement*> joints;  ///< in the order of the file
  std::unordered_map<std::string, int> index;       ///< index of each link, by name
  std::unordered_set<std::string> jointNames;       ///< of all joints, including those that have faults
};

/// Reads the tree. Faults are added to `faults.errors`, each naming the line and the link or joint. With
/// faults, joints may be missing, and links are in the order of the file.
/// @throws Error if nothing can be checked: no links, or more than 20,000.
UrdfTree readTree(const tinyxml2::XMLElement& robot, const std::string& path, LoadFaults& faults);

}  // namespace fcl_stpbv::detail
