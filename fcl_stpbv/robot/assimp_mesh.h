// Reading a mesh file by assimp, within this process.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fcl_stpbv/robot/child_process.h"
#include "fcl_stpbv/volume/tessellate.h"

namespace fcl_stpbv::detail {

/// loadMesh() of a mesh. assimp trusts what it reads: counts that fill the memory, loops, depths that
/// overflow the stack. So this is for a child process, which `limits` are of.
TriangleMesh readByAssimp(const std::string& path, const Eigen::Vector3d& scale, ChildLimits& limits);

/// A body that has collapsed would count as a point and be told to be clear. `several`: the points were
/// distinct before they were scaled. @throws Error naming the file.
void requireSize(const std::vector<Eigen::Vector3d>& points, bool several, const std::string& path);

}  // namespace fcl_stpbv::detail
