// The content of mesh files, for files that are written together.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/volume/tessellate.h"

namespace fcl_stpbv::detail {

/// What saveColoured() writes into the file `path`. @throws Error as saveMesh().
std::string colouredText(const std::string& path, const std::vector<TriangleMesh>& meshes);

}  // namespace fcl_stpbv::detail
