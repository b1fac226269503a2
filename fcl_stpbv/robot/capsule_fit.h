// Recognises capsules, which URDF files write as a cylinder with a sphere at each end.
#pragma once

#include <vector>

#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv::detail {

/// Replaces each cylinder that has a sphere of its radius centred on both ends, to a micrometre, by one
/// capsule that contains all three. The spheres are removed.
void joinCapsules(std::vector<ShapeModel>& shapes);

}  // namespace fcl_stpbv::detail
