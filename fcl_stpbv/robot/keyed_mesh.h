// Meshes and their keys in the cache, both from the same bytes.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "fcl_stpbv/mesh/mesh_content.h"
#include "fcl_stpbv/robot/link_geometry.h"

namespace fcl_stpbv::detail {

/// A mesh file as it was at one moment. Its file is read once, so the key, the text and the mesh belong
/// together even if somebody saves the file meanwhile.
class KeyedMesh {
 public:
  /// @throws Error naming the file.
  KeyedMesh(std::string file, const Eigen::Vector3d& scale);
  /// A file that was read before. @throws PassingError if its key is not `key` any more.
  KeyedMesh(std::string file, const Eigen::Vector3d& scale, const std::string& key);
  /// The mesh of a body, as it was when the body was made.
  explicit KeyedMesh(const Body& body) : KeyedMesh(body.file, body.scale, body.meshKey) {}

  /// The key in the cache (volume_cache.h): a digest of the file's content and of the scale.
  const std::string& key() const { return key_; }
  const std::string& text() const { return text_; }
  /// @throws Error naming the file.
  TriangleMesh mesh() const;

 private:
  std::string file_;
  Eigen::Vector3d scale_;
  std::string text_, key_;
  std::optional<TriangleMesh> mesh_;  // of a glTF
};

/// The key of a body's mesh. The file is read only if the key is not known yet.
std::string meshKey(const Body& body);

}  // namespace fcl_stpbv::detail
