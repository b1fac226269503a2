// Finds errors in glTF files that assimp silently ignores: vertices that are not floats, indices and ranges
// beyond the end, and extensions and deformations that move vertices.
#pragma once

#include <string>
#include <string_view>

#include "fcl_stpbv/robot/gltf_file.h"

namespace fcl_stpbv::detail {

/// Checks what can change the shape in a glTF or GLB; materials, normals and animations are left aside.
/// @throws Error "name: accessors[0] ..." saying what is wrong and what would work.
void checkGltf(std::string_view text, const std::string& name, const ReadPart& readPart);

}  // namespace fcl_stpbv::detail
