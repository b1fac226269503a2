// The content of a mesh's file, and the mesh in it.
#pragma once

#include <Eigen/Core>
#include <string>

#include "fcl_stpbv/volume/tessellate.h"

namespace fcl_stpbv::detail {

/// The content of a mesh's file. @throws Error naming the file if there is none or the scale is wrong.
std::string meshText(const std::string& path, const Eigen::Vector3d& scale);

/// The mesh in the content of a file, as loadMesh() reads it. @throws Error naming the file.
TriangleMesh meshOf(const std::string& text, const std::string& path, const Eigen::Vector3d& scale);

}  // namespace fcl_stpbv::detail
