// The files that reading a mesh may open.
#pragma once

#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/mesh/child_process.h"
#include "fcl_stpbv/mesh/file_ending.h"
#include "fcl_stpbv/mesh/uri_text.h"

namespace fcl_stpbv::detail {

/// Opens only the mesh and, for glTF, the regular files with its vertices, beside the mesh or in folders
/// below it. It opens no other files that a mesh may refer to, no materials, pipes or devices. Each file is
/// read once, so that what was checked is what assimp reads, even if somebody saves the file meanwhile. It
/// raises the limits of the child process in proportion to the files' sizes.
class ReadableFiles : public Assimp::DefaultIOSystem {
 public:
  /// `text`, the content of the mesh's file, must outlive this object.
  ReadableFiles(const std::string& mesh, const std::string& text, ChildLimits& limits)
      : mesh_(mesh), text_(text), limits_(limits) {
    limits_.allow(text.size());
  }

  bool Exists(const char* path) const override { return !found(path).empty(); }
  Assimp::IOStream* Open(const char* path, const char* /*mode*/) override {
    const std::string file = found(path);
    if (file.empty()) return nullptr;
    const std::string& bytes = bytesOf(file);
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  }

  /// A file that the mesh names, in the place where assimp looks for it.
  std::optional<std::string> part(const std::string& name) {
    const std::string file = found(folder() + name);
    if (file.empty()) return std::nullopt;
    return bytesOf(file);
  }

 private:
  std::string folder() const { return mesh_.substr(0, mesh_.rfind('/') + 1); }

  // The file that a path means: as it is written, else with %20 and the like decoded. "" if there is no such
  // file or it may not be read.
  std::string found(const std::string& path) const {
    if (mayRead(path)) return path;
    const std::size_t start = path.compare(0, folder().size(), folder()) == 0 ? folder().size() : 0;
    const std::string decoded = path.substr(0, start) + percentDecoded(path.substr(start));
    return mayRead(decoded) ? decoded : "";
  }

  bool mayRead(const std::string& path) const {
    std::error_code ignored;
    return path == mesh_ || (std::filesystem::is_regular_file(path, ignored) && isPart(path));
  }

  const std::string& bytesOf(const std::string& path) {
    if (path == mesh_) return text_;
    const auto known = parts_.find(path);
    if (known != parts_.end()) return known->second;
    std::error_code ignored;
    limits_.allow(std::filesystem::file_size(path, ignored));
    return parts_.emplace(path, readText(path)).first->second;
  }

  bool isPart(const std::string& path) const {
    namespace fs = std::filesystem;
    if (lowerExtension(mesh_) != ".gltf") return false;
    std::error_code ignored;
    const fs::path part = fs::canonical(path, ignored);
    // If the mesh is a symbolic link, files beside its target are allowed too.
    for (const fs::path& folder : {fs::canonical(fs::absolute(mesh_, ignored).parent_path(), ignored),
                                   fs::canonical(mesh_, ignored).parent_path()}) {
      const fs::path inside = part.lexically_relative(folder);
      if (!part.empty() && !folder.empty() && !inside.empty() && *inside.begin() != "..") return true;
    }
    return false;
  }

  const std::string mesh_;
  const std::string& text_;
  ChildLimits& limits_;
  std::map<std::string, std::string> parts_;  // map entries do not move: assimp reads them in place
};

}  // namespace fcl_stpbv::detail
