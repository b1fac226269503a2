// Damage in text meshes that assimp silently ignores: cut lines, decimal commas, indices without a vertex.
#pragma once

#include <string>
#include <string_view>

namespace fcl_stpbv::detail {

/// Checks OBJ, text STL, OFF and COLLADA, told by `extension` (".obj", lower case); others pass.
/// @returns what checkCollada() does, else 0.
/// @throws Error "name:line: ..." saying what is wrong.
double checkTextMesh(std::string_view text, const std::string& extension, const std::string& name);

}  // namespace fcl_stpbv::detail
