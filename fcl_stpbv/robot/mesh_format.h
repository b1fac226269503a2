// The format of a mesh file, as assimp takes it, and the checks that each format needs.
#pragma once

#include <string>
#include <string_view>

#include "fcl_stpbv/robot/gltf_file.h"

struct aiScene;
namespace Assimp {
class Importer;
}

namespace fcl_stpbv::detail {

/// The ending, such as ".obj", of the format that assimp will read a file as, where the file's name or its
/// first bytes settle that; "" otherwise. Checked before, a fault is told better than by assimp.
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
