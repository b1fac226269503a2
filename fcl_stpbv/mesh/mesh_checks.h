// Checks of mesh files before assimp reads them. assimp silently ignores much damage, and some of it crashes
// its readers.
#pragma once

#include <string>
#include <string_view>

#include "fcl_stpbv/mesh/gltf_file.h"

namespace fcl_stpbv::detail {

/// Whether a file has the length of a binary STL: a header of 80 bytes, the number of triangles, and 50 bytes
/// for each.
bool hasLengthOfBinaryStl(std::string_view text);

// Each throws Error saying what is wrong, with the file's name and, in texts, the line.

/// OBJ, text STL, OFF and COLLADA, depending on `extension` (".obj", lower case). Other formats pass.
/// @returns the result of checkCollada() for COLLADA, else 0.
double checkTextMesh(std::string_view text, const std::string& extension, const std::string& name);

/// Whether an OFF file matches its header, and whether assimp reads its lines correctly.
void checkOff(std::string_view text, const std::string& name);

/// References, arrays and numbers of a COLLADA file.
/// @returns the largest intermediate coordinate in the transforms within a node above a shape (m). It may be
/// much larger than the result, because transforms may cancel.
double checkCollada(std::string_view text, const std::string& name);

/// Whether a PLY file matches its header, which assimp's reader trusts even beyond the end of the file.
void checkPly(std::string_view text, const std::string& name);

/// What can change the shape in a glTF or GLB: vertices that are not floats, indices and ranges beyond the
/// end, and extensions and deformations that move vertices. Materials, normals and animations are left aside.
void checkGltf(std::string_view text, const std::string& name, const ReadPart& readPart);

}  // namespace fcl_stpbv::detail
