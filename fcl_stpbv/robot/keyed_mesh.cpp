// The key of a mesh is the digest of the file's bytes. A glTF may store its vertices in other files, so its
// key is the digest of the mesh's vertices and triangles.
#include "fcl_stpbv/robot/keyed_mesh.h"

#include <utility>

#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/mesh/file_ending.h"
#include "fcl_stpbv/mesh/passing_error.h"
#include "fcl_stpbv/robot/volume_cache.h"

namespace fcl_stpbv::detail {
namespace {

// The number of vertices comes first, so that no other mesh has the same text, and no cloud of points is it.
std::string contentOf(const TriangleMesh& mesh) {
  std::string content = std::to_string(mesh.vertices.size()) + " vertices\n";
  for (const Eigen::Vector3d& p : mesh.vertices) {
    appendVector(content, p);
    content += '\n';
  }
  for (const auto& [a, b, c] : mesh.triangles)
    content += std::to_string(a) + ' ' + std::to_string(b) + ' ' + std::to_string(c) + '\n';
  return content;
}

}  // namespace

KeyedMesh::KeyedMesh(std::string file, const Eigen::Vector3d& scale)
    : file_(std::move(file)), scale_(scale), text_(meshText(file_, scale)) {
  if (lowerExtension(file_) == ".gltf") mesh_ = meshOf(text_, file_, scale_);
  appendVector(key_, scale);
  key_ += ' ' + digestOf(mesh_ ? contentOf(*mesh_) : text_);
}

KeyedMesh::KeyedMesh(std::string file, const Eigen::Vector3d& scale, const std::string& key)
    : KeyedMesh(std::move(file), scale) {
  if (!key.empty() && key_ != key) refuseChanged(file_);
}

TriangleMesh KeyedMesh::mesh() const { return mesh_ ? *mesh_ : meshOf(text_, file_, scale_); }

std::string meshKey(const Body& body) {
  return body.meshKey.empty() ? KeyedMesh(body.file, body.scale).key() : body.meshKey;
}

}  // namespace fcl_stpbv::detail
