// Finds damage in text meshes that assimp silently ignores: cut lines, decimal commas, indices without a
// vertex.
#pragma once

#include <string>
#include <string_view>

namespace fcl_stpbv::detail {

/// Checks OBJ, text STL, OFF and COLLADA, depending on `extension` (".obj", lower case). Other formats pass.
/// @returns the result of checkCollada() for COLLADA, else 0.
/// @throws Error "name:line: ..." saying what is wrong.
double checkTextMesh(std::string_view text, const std::string& extension, const std::string& name);

}  // namespace fcl_stpbv::detail
