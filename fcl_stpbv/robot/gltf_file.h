// The parts of a glTF file: its JSON, and the bytes of its buffers.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace fcl_stpbv::detail {

/// Reads a file that a mesh names, by its path relative to the mesh; nothing where it may not or cannot.
using ReadPart = std::function<std::optional<std::string>(const std::string& path)>;

struct GltfText {
  std::string_view json;
  std::optional<std::string_view> chunk;  // a GLB's own bytes
};

/// Takes a glTF or GLB apart. @throws Error where it is neither or is cut off.
GltfText splitGltf(std::string_view text, const std::string& name);

/// The buffers of a document, each read when it is first asked for.
class GltfBuffers {
 public:
  /// All but `chunk` must outlive this, and what `chunk` refers to.
  GltfBuffers(const nlohmann::json& document, const GltfText& text, const ReadPart& readPart,
              const std::string& name)
      : document_(document), chunk_(text.chunk), readPart_(readPart), name_(name) {}

  /// The first `byteLength` bytes of a buffer, which is all that others may use of it.
  /// @throws Error where it does not exist, is shorter, or its bytes cannot be had.
  std::string_view bytes(std::size_t index);

 private:
  std::string read(const std::string& place, const std::string& uri) const;

  const nlohmann::json& document_;
  std::optional<std::string_view> chunk_;
  const ReadPart& readPart_;
  const std::string& name_;
  std::map<std::size_t, std::string> read_;
};

}  // namespace fcl_stpbv::detail
