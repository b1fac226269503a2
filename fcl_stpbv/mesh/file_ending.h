// The extension of a file's name, which identifies the format.
#pragma once

#include <filesystem>
#include <string>

#include "fcl_stpbv/mesh/mesh_lines.h"

namespace fcl_stpbv::detail {

/// The extension with its dot, such as ".gltf", in lower case; "" if there is none.
inline std::string lowerExtension(const std::string& path) {
  return inSmallLetters(std::filesystem::path(path).extension().string());
}

}  // namespace fcl_stpbv::detail
