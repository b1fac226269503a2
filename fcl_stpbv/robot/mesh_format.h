// Finds the format in which assimp reads a mesh file, and runs the checks of that format.
#pragma once

#include <string>
#include <string_view>

#include "fcl_stpbv/robot/gltf_file.h"

struct aiScene;
namespace Assimp {
class Importer;
}

namespace fcl_stpbv::detail {

/// The extension, such as ".obj", of the format in which assimp will read a file, if the file's name or its
/// first bytes decide that; "" otherwise. A check before assimp gives better error messages.
std::string expectedFormat(std::string_view text, const std::string& path);

/// The same of the format that assimp has read a file as: a file's name may promise another one.
std::string formatOf(const aiScene& scene, const Assimp::Importer& importer);

/// Checks a file's content for what assimp reads over in its format. Formats that state a unit which is not
/// applied are refused.
/// @returns the largest number within a node's transform above a shape (m), which assimp multiplies in single
/// precision: of COLLADA, else 0.
/// @throws Error naming the file, what is wrong and what would work.
double checkMeshFormat(std::string_view text, const std::string& format, const std::string& path,
                       const ReadPart& readPart);

}  // namespace fcl_stpbv::detail
