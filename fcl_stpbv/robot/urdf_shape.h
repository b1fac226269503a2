// The shapes of a link in a URDF.
#pragma once

#include <tinyxml2.h>

#include <string>
#include <vector>

#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv::detail {

/// The shapes of a `<link>` for one use, "collision" or "visual"; cylinders and spheres that make a capsule
/// are one. A message for each shape that is wrong goes to `faults`. `path` is the URDF's.
std::vector<ShapeModel> readShapes(const tinyxml2::XMLElement& link, const char* use, const std::string& path,
                                   std::vector<std::string>& faults);

}  // namespace fcl_stpbv::detail
