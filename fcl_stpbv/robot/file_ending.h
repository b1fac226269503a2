// The ending of a file's name, which tells formats apart.
#pragma once

#include <filesystem>
#include <string>

#include "fcl_stpbv/robot/mesh_lines.h"

namespace fcl_stpbv::detail {

/// The ending with its point, such as ".gltf", in small letters; "" for none.
inline std::string lowerExtension(const std::string& path) {
  return inSmallLetters(std::filesystem::path(path).extension().string());
}

}  // namespace fcl_stpbv::detail
