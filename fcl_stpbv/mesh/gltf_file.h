// The parts of a glTF file: its JSON, and the bytes of its buffers.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace fcl_stpbv::detail {

/// Reads a file that a mesh names, by its path relative to the mesh. No value if the file may not or cannot
/// be read.
using ReadPart = std::function<std::optional<std::string>(const std::string& path)>;

struct GltfText {
  std::string_view json;
  std::optional<std::string_view> chunk;  // a GLB's own bytes
};

/// Takes a glTF or GLB apart. @throws Error if the text is neither or is cut off.
GltfText splitGltf(std::string_view text, const std::string& name);

/// The buffers of a document. Each is read when it is first requested.
class GltfBuffers {
 public:
  /// All arguments except `chunk` must outlive this object, and so must the bytes that `chunk` refers to.
  GltfBuffers(const nlohmann::json& document, const GltfText& text, const ReadPart& readPart,
              const std::string& name)
      : document_(document), chunk_(text.chunk), readPart_(readPart), name_(name) {}

  /// The first `byteLength` bytes of a buffer. Views may not use other bytes of it. @throws Error if the
  /// buffer does not exist, is shorter, or cannot be read.
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
