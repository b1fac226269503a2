// Takes glTF apart as assimp does: a GLB is a head, the JSON and one chunk of bytes; other buffers are base64
// in the JSON or files beside it.
#include "fcl_stpbv/mesh/gltf_file.h"

#include <algorithm>
#include <array>
#include <utility>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/file_ending.h"
#include "fcl_stpbv/mesh/mesh_lines.h"

namespace fcl_stpbv::detail {
namespace {

constexpr std::size_t kHead = 12, kChunkHead = 8;

std::size_t littleEndian(std::string_view bytes, std::size_t at) {
  std::size_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

// Returns the chunk that begins at `at`, and moves `at` to the next chunk.
std::string_view takeChunk(std::string_view text, std::size_t& at, std::string_view kind,
                           const std::string& name) {
  const std::string ending = "; the file is damaged, export it again";
  if (text.size() - at < kChunkHead || text.substr(at + 4, 4) != kind)
    throw Error(name + ": has no chunk " + std::string(kind.substr(0, 3)) + " where GLB has one" + ending);
  const std::size_t length = littleEndian(text, at);
  at += kChunkHead;
  if (text.size() - at < length)
    throw Error(name + ": ends within its chunk " + std::string(kind.substr(0, 3)) + ending);
  const std::string_view chunk = text.substr(at, length);
  at = std::min(text.size(), at + (length + 3) / 4 * 4);
  return chunk;
}

std::optional<std::string> fromBase64(std::string_view text) {
  static const std::array<int, 256> kValues = [] {
    std::array<int, 256> values{};
    values.fill(-1);
    const std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < digits.size(); ++i)
      values[static_cast<unsigned char>(digits[i])] = static_cast<int>(i);
    return values;
  }();
  if (text.size() % 4 != 0) return std::nullopt;
  for (int i = 0; i < 2 && !text.empty() && text.back() == '='; ++i) text.remove_suffix(1);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  unsigned held = 0, bits = 0;
  for (const char c : text) {
    const int value = kValues[static_cast<unsigned char>(c)];
    if (value < 0) return std::nullopt;
    held = held << 6 | static_cast<unsigned>(value);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(held >> bits & 0xffu);
  }
  return bytes;
}

}  // namespace

GltfText splitGltf(std::string_view text, const std::string& name) {
  if (text.substr(0, 4) != "glTF") {
    refuseNul(text, name);
    return {text, {}};
  }
  if (text.size() < kHead || littleEndian(text, 4) != 2)
    throw Error(name + ": is no GLB of version 2, the one that is read; export it as glTF 2.0");
  // assimp decides by the length in the head, not by the file's length, whether there are bytes.
  const std::size_t length = std::min(text.size(), littleEndian(text, 8));
  std::size_t at = kHead;
  GltfText parts{takeChunk(text, at, "JSON", name), {}};
  if (at + kChunkHead <= length) parts.chunk = takeChunk(text, at, std::string_view("BIN\0", 4), name);
  return parts;
}

std::string_view GltfBuffers::bytes(std::size_t index) {
  const std::string place = name_ + ": buffers[" + std::to_string(index) + "] ";
  const auto list = document_.find("buffers");
  if (list == document_.end() || !list->is_array() || index >= list->size() || !(*list)[index].is_object())
    throw Error(place + "is named and does not exist; the file is damaged, export it again");
  const nlohmann::json& buffer = (*list)[index];
  const auto length = buffer.find("byteLength"), uri = buffer.find("uri");
  if (length == buffer.end() || !length->is_number_unsigned())
    throw Error(place + "has no byteLength, the number of its bytes; export the mesh again");
  if (uri != buffer.end() && (!uri->is_string() || (chunk_ && index == 0)))
    throw Error(place + "has a uri that is not read; export the mesh as one .glb, or as .gltf with a .bin");
  std::string_view all;
  if (uri == buffer.end()) {
    if (!chunk_ || index != 0)
      throw Error(place + "has no uri that says where its bytes are; export the mesh again");
    all = *chunk_;
  } else {
    auto found = read_.find(index);
    if (found == read_.end())
      found = read_.emplace(index, read(place, uri->get_ref<const std::string&>())).first;
    all = found->second;
  }
  const std::size_t bytes = length->get<std::size_t>();
  if (bytes > all.size())
    throw Error(place + "has " + std::to_string(all.size()) + " bytes, but its byteLength is " +
                std::to_string(bytes) + "; the file is damaged, export it again");
  return all.substr(0, bytes);
}

std::string GltfBuffers::read(const std::string& place, const std::string& uri) const {
  if (uri.substr(0, 5) != "data:") {
    std::string path = uri;  // assimp tries the name as it is, then without the backslashes of Windows
    std::replace(path.begin(), path.end(), '\\', '/');
    for (const std::string& name : {uri, path})
      if (std::optional<std::string> part = readPart_(name)) return std::move(*part);
    const bool alone = lowerExtension(name_) != ".gltf";  // ReadableFiles allows other files only for .gltf
    throw Error(place + "is in a file '" + uri +
                (alone
                     ? "', which only a .gltf may have; export the mesh as one .glb, or as .gltf with a .bin"
                     : "' that cannot be read; put it beside the mesh or below"));
  }
  const std::string_view text = uri;
  const std::size_t start = std::min(text.find(','), text.size() - 1) + 1;
  constexpr std::string_view kBase64 = ";base64,";
  std::optional<std::string> bytes;
  if (start > kBase64.size() && text.substr(start - kBase64.size(), kBase64.size()) == kBase64)
    bytes = fromBase64(text.substr(start));
  if (!bytes) throw Error(place + "is no base64; the file is damaged, export it again");
  return std::move(*bytes);
}

}  // namespace fcl_stpbv::detail
