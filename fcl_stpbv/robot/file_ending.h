// The ending of a file's name, which tells formats apart.
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace fcl_stpbv::detail {

/// The ending with its point, such as ".gltf", in small letters; "" for none.
inline std::string lowerExtension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace fcl_stpbv::detail
