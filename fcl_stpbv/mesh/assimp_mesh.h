// Reads a mesh file by assimp, in the calling process.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fcl_stpbv/mesh/child_process.h"
#include "fcl_stpbv/volume/tessellate.h"

namespace fcl_stpbv::detail {

/// loadMesh() of a mesh, whose file has the content `text`. If the text is `inMemory`, it belongs to no file
/// or to one whose name does not tell its format: the content tells it, and `path` is a name for messages.
/// assimp does not check its input: a file may have counts that fill the memory, loops, or a nesting that
/// overflows the stack. So call this only in a child process; `limits` are the limits of that process.
TriangleMesh readByAssimp(const std::string& path, const std::string& text, bool inMemory,
                          const Eigen::Vector3d& scale, ChildLimits& limits);

/// Checks that a body has not collapsed to a point by scaling; it would wrongly be reported as clear.
/// `several`: the points were distinct before scaling. @throws Error naming the file.
void requireSize(const std::vector<Eigen::Vector3d>& points, bool several, const std::string& path);

}  // namespace fcl_stpbv::detail
