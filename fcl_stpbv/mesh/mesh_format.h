// Finds the format in which assimp reads a mesh file, and runs the checks of that format.
#pragma once

#include <string>
#include <string_view>

#include "fcl_stpbv/mesh/gltf_file.h"

struct aiScene;
namespace Assimp {
class Importer;
}

namespace fcl_stpbv::detail {

/// The extension, such as ".obj", of the format in which assimp will read a file, if the file's name or its
/// first bytes decide that; "" otherwise. A check before assimp gives better error messages.
std::string expectedFormat(std::string_view text, const std::string& path);

/// The extension of a text's format by its content alone, for a mesh without a name. assimp itself looks at
/// the content of few formats. "" for a format that only assimp may know.
std::string formatByContent(std::string_view text);

/// The extension of the format in which assimp has read a file. The file's name may say another format.
std::string formatOf(const aiScene& scene, const Assimp::Importer& importer);

/// Checks a file's content for errors that assimp ignores in its format. Formats that state a unit which is
/// not applied are refused.
/// @returns for COLLADA the largest number within a node's transform above a shape (m), which assimp
/// multiplies in single precision; for other formats 0.
/// @throws Error naming the file, what is wrong and what would work.
double checkMeshFormat(std::string_view text, const std::string& format, const std::string& path,
                       const ReadPart& readPart);

}  // namespace fcl_stpbv::detail
