// Writes meshes by assimp as OBJ, STL, PLY or GLB, depending on the name's ending. A file is written
// completely or not at all.
#include "fcl_stpbv/mesh/mesh_write.h"

#include <assimp/cexport.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Exporter.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/atomic_write.h"
#include "fcl_stpbv/mesh/file_ending.h"
#include "fcl_stpbv/mesh/mesh_file.h"

namespace fcl_stpbv {
namespace {

using namespace detail;

struct Format {
  const char* extension;
  const char* assimpId;
};

// OBJ is written without its second file of materials, so that one preview is one file.
constexpr std::array<Format, 4> kFormats{
    {{".obj", "objnomtl"}, {".stl", "stlb"}, {".ply", "plyb"}, {".glb", "glb2"}}};

const Format* formatOf(const std::string& path) {
  const std::string extension = detail::lowerExtension(path);
  const auto found = std::find_if(kFormats.begin(), kFormats.end(),
                                  [&](const Format& f) { return extension == f.extension; });
  return found == kFormats.end() ? nullptr : found;
}

// assimp's structures own what they point to through plain arrays and free them in their destructors.
std::unique_ptr<aiMesh> toAssimp(const TriangleMesh& mesh) {
  auto out = std::make_unique<aiMesh>();
  out->mName = "stpbv";
  out->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  out->mNumVertices = static_cast<unsigned>(mesh.vertices.size());
  out->mVertices = new aiVector3D[mesh.vertices.size()];
  std::transform(mesh.vertices.begin(), mesh.vertices.end(), out->mVertices, [](const Eigen::Vector3d& v) {
    return aiVector3D(static_cast<ai_real>(v.x()), static_cast<ai_real>(v.y()), static_cast<ai_real>(v.z()));
  });
  out->mNumFaces = static_cast<unsigned>(mesh.triangles.size());
  out->mFaces = new aiFace[mesh.triangles.size()];
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    aiFace& face = out->mFaces[f];
    face.mNumIndices = 3;
    face.mIndices = new unsigned[3];
    std::transform(mesh.triangles[f].begin(), mesh.triangles[f].end(), face.mIndices,
                   [](int index) { return static_cast<unsigned>(index); });
  }
  return out;
}

// assimp checks neither indices nor coordinates, and reads beyond the mesh's memory for an invalid index.
void requireSound(const TriangleMesh& mesh, const std::string& path) {
  const auto exists = [&](int i) { return i >= 0 && static_cast<std::size_t>(i) < mesh.vertices.size(); };
  for (const std::array<int, 3>& triangle : mesh.triangles)
    if (!std::all_of(triangle.begin(), triangle.end(), exists))
      throw Error(path + ": not written, a triangle names a vertex that does not exist: there are " +
                  std::to_string(mesh.vertices.size()));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (!(mesh.vertices[i].array().abs() <= std::numeric_limits<float>::max()).all())
      throw Error(path + ": not written, vertex " + std::to_string(i) +
                  " has a coordinate that is no number or beyond single precision");
}

// A different colour for each mesh: the hue turns by the golden section from one mesh to the next.
aiColor4D colourOf(std::size_t mesh) {
  const auto channel = [&](double shift) {
    const double hue = 0.618034 * static_cast<double>(mesh) + shift;
    return static_cast<ai_real>(0.55 + 0.4 * std::cos(6.283185307 * hue));
  };
  return {channel(0), channel(1.0 / 3), channel(2.0 / 3), 1};
}

void colour(aiMesh& mesh, aiMaterial& material, std::size_t number) {
  const aiColor4D colour = colourOf(number);
  material.AddProperty(&colour, 1, AI_MATKEY_COLOR_DIFFUSE);
  mesh.mColors[0] = new aiColor4D[mesh.mNumVertices];
  std::fill_n(mesh.mColors[0], mesh.mNumVertices, colour);
}

std::unique_ptr<aiScene> sceneOf(const std::vector<TriangleMesh>& meshes) {
  auto scene = std::make_unique<aiScene>();
  const unsigned count = static_cast<unsigned>(meshes.size());
  scene->mNumMaterials = scene->mNumMeshes = count;
  scene->mMaterials = new aiMaterial*[count];
  scene->mMeshes = new aiMesh*[count];
  scene->mRootNode = new aiNode("stpbv");
  scene->mRootNode->mNumMeshes = count;
  scene->mRootNode->mMeshes = new unsigned[count];
  for (unsigned k = 0; k < count; ++k) {
    scene->mMaterials[k] = new aiMaterial;
    scene->mMeshes[k] = toAssimp(meshes[k]).release();
    scene->mMeshes[k]->mMaterialIndex = k;
    scene->mRootNode->mMeshes[k] = k;
    if (count > 1) colour(*scene->mMeshes[k], *scene->mMaterials[k], k);
  }
  return scene;
}

std::string exported(const aiScene& scene, const char* assimpId, const std::string& path) {
  Assimp::Exporter exporter;
  const aiExportDataBlob* blob = exporter.ExportToBlob(&scene, assimpId);
  if (blob == nullptr) throw Error(path + ": cannot be written (" + exporter.GetErrorString() + ")");
  return {static_cast<const char*>(blob->data), blob->size};
}

// Whether the first byte of a binary PLY's values equals a line feed. assimp would skip that byte.
bool beginsWithLineFeed(std::string_view ply) {
  constexpr std::string_view kEnd = "end_header\n";
  return ply.substr(ply.find(kEnd) + kEnd.size(), 1) == "\n";
}

}  // namespace

bool canSaveMesh(const std::string& path) { return formatOf(path) != nullptr; }

void saveMesh(const std::string& path, const TriangleMesh& mesh) { saveColoured(path, {mesh}); }

void saveColoured(const std::string& path, const std::vector<TriangleMesh>& meshes) {
  atomicWrite(path, colouredText(path, meshes));
}

std::string detail::colouredText(const std::string& path, const std::vector<TriangleMesh>& meshes) {
  const Format* format = formatOf(path);
  if (format == nullptr) throw Error(path + ": no mesh format of this name; use .obj, .stl, .ply or .glb");
  const bool none =
      std::any_of(meshes.begin(), meshes.end(), [](const auto& m) { return m.triangles.empty(); });
  if (meshes.empty() || none) throw Error(path + ": not written, the mesh has no triangles");
  for (const TriangleMesh& mesh : meshes) requireSound(mesh, path);
  const std::unique_ptr<aiScene> scene = sceneOf(meshes);
  const bool isPly = format->assimpId == std::string_view("plyb");
  // assimp 5.2 writes a colour's channels into a binary PLY as floats, although the header says that they are
  // bytes.
  const bool isText = isPly && meshes.size() > 1;
  std::string text = exported(*scene, isText ? "ply" : format->assimpId, path);
  if (isPly && !isText && beginsWithLineFeed(text)) text = exported(*scene, "ply", path);
  return text;
}

}  // namespace fcl_stpbv
