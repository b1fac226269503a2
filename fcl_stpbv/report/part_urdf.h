// Writes a URDF in which each collision mesh is replaced by its convex parts.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv::report {

/// What a URDF with parts is made of.
struct PartUrdf {
  const RobotModel* robot;
  bool visual = false;  ///< the bodies were made from the visual shapes; these become the collision shapes
  /// The names of the meshes that replace a mesh shape, by the place of the shape. A shape without an entry
  /// stays as it is.
  std::map<std::string, std::vector<std::string>> meshes;
  std::string folder;  ///< where the URDF will be: relative names of other meshes are changed to match
};

/// The robot's URDF with one `<collision>` for each part. Name, origin and other contents are copied from the
/// mesh's element, without the scale, which is already applied to the parts. Everything else stays. @throws
/// Error naming the file.
std::string urdfWithParts(const PartUrdf& parts);

}  // namespace fcl_stpbv::report
