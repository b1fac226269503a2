// Finds a mesh file's format by assimp's own rules: by the name's extension if exactly one reader knows it,
// otherwise by the content.
#include "fcl_stpbv/mesh/mesh_format.h"

#include <assimp/commonMetaData.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/file_ending.h"
#include "fcl_stpbv/mesh/mesh_checks.h"
#include "fcl_stpbv/mesh/mesh_lines.h"
#include "fcl_stpbv/words.h"

namespace fcl_stpbv::detail {
namespace {

// Extensions that only one reader knows. For .gltf, .glb, .xml and unknown extensions, assimp's readers look
// at the content.
constexpr Words kByName{".3mf", ".amf", ".dae", ".dxf", ".fbx", ".obj", ".off", ".ogex", ".ply", ".stl"};

// Formats that state a unit, often millimetres or centimetres, which assimp does not apply.
constexpr Words kWithUnit{".3mf", ".amf", ".dxf", ".fbx", ".ogex"};

bool looksLikeGltf(std::string_view text) {
  const std::size_t start = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  return text.substr(0, 4) == "glTF" || text.substr(start, 1) == "{";
}

// The first word of the first line that is no comment.
std::string_view firstWord(std::string_view text) {
  const std::string name;
  MeshLines lines(text, name);
  while (lines.next()) {
    std::string_view line = lines.text();
    const std::string_view word = takeWord(line);
    if (!word.empty() && word[0] != '#') return word;
  }
  return "";
}

}  // namespace

std::string formatByContent(std::string_view text) {
  constexpr Words kObj{"v", "vn", "vt", "vp", "f", "l", "p", "g", "o", "s", "mtllib", "usemtl"};
  constexpr Words kOff{"OFF", "COFF", "NOFF", "STOFF", "CNOFF", "STCNOFF"};
  constexpr std::size_t kHead = 4096;  // comments may come before the root of an XML text
  if (text.substr(0, 3) == "ply") return ".ply";
  if (text.substr(0, 4) == "glTF") return ".glb";
  if (hasLengthOfBinaryStl(text)) return ".stl";
  if (text.substr(0, kHead).find("<COLLADA") != std::string_view::npos) return ".dae";
  const std::string_view word = firstWord(text);
  if (word == "solid") return ".stl";
  if (holds(kOff, word)) return ".off";
  if (holds(kObj, word)) return ".obj";
  return word.substr(0, 1) == "{" ? ".gltf" : "";
}

std::string expectedFormat(std::string_view text, const std::string& path) {
  const std::string extension = lowerExtension(path);
  if (holds(kByName, extension)) return extension;
  if (text.substr(0, 3) == "ply") return ".ply";
  if ((extension == ".gltf" || extension == ".glb") && looksLikeGltf(text)) return ".gltf";
  return "";
}

std::string formatOf(const aiScene& scene, const Assimp::Importer& importer) {
  aiString format;
  if (scene.mMetaData == nullptr || !scene.mMetaData->Get(AI_METADATA_SOURCE_FORMAT, format)) return "";
  for (std::size_t i = 0; i < importer.GetImporterCount(); ++i) {
    const aiImporterDesc& reader = *importer.GetImporterInfo(i);
    const std::string_view endings = reader.mFileExtensions;
    if (std::string_view(reader.mName) == format.C_Str())
      return "." + std::string(endings.substr(0, endings.find(' ')));
  }
  return "";
}

double checkMeshFormat(std::string_view text, const std::string& format, const std::string& path,
                       const ReadPart& readPart) {
  const bool inOwnUnit = format == ".x3d" && text.find("conversionFactor") != std::string_view::npos;
  if (holds(kWithUnit, format) || inOwnUnit)
    throw Error(path +
                ": is of a format that states a unit of its own, often millimetres or centimetres, which is "
                "not read; convert it to STL or OBJ in metres");
  if (format == ".dae" && text.substr(0, 2) == "PK")
    throw Error(path + ": is a packed COLLADA, which is not read; unpack it and give the .dae in it");
  if (format == ".ply")
    checkPly(text, path);
  else if (format == ".gltf")
    checkGltf(text, path, readPart);
  else
    return checkTextMesh(text, format, path);
  return 0;
}

}  // namespace fcl_stpbv::detail
