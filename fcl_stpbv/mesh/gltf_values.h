// Values of a glTF document as assimp takes them, and the bytes that its accessors reach.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fcl_stpbv/mesh/gltf_file.h"

namespace fcl_stpbv::detail {

/// A value of the document and its place, such as "accessors[3]".
struct GltfItem {
  const nlohmann::json* value;
  std::string place;
};

/// The elements of an accessor: `count` elements of `size` bytes each, at distances of `stride` bytes.
struct GltfElements {
  std::string_view bytes;
  std::size_t count = 0, size = 0, stride = 0;

  /// An element as an unsigned number of `size` bytes.
  std::uint32_t number(std::size_t i) const;
};

class GltfValues {
 public:
  /// All arguments must outlive this object.
  GltfValues(const nlohmann::json& root, GltfBuffers& buffers, const std::string& name)
      : root_(root), buffers_(buffers), name_(name) {}

  [[noreturn]] void refuse(const GltfItem& item, const std::string& message) const;

  /// Throws like refuse(), for a fault that only the author of the file can correct.
  [[noreturn]] void damaged(const GltfItem& item, const std::string& message) const;

  /// A list of the document (empty if it is missing), and one of its items.
  std::vector<GltfItem> list(const char* key) const;
  GltfItem at(const char* key, std::size_t index) const;

  /// The items of a list within an item.
  std::vector<GltfItem> list(const GltfItem& item, const char* key) const;

  /// A member of an item; no value if it is missing.
  std::optional<GltfItem> find(const GltfItem& item, const char* key) const;

  /// A non-negative integer; assimp treats any other value as missing.
  std::size_t whole(const GltfItem& item) const;
  std::size_t whole(const GltfItem& item, const char* key) const;
  std::size_t whole(const GltfItem& item, const char* key, std::size_t missing) const;

  /// The numbers of a list, which must have exactly `count` of them.
  std::vector<double> numbers(const GltfItem& item, std::size_t count) const;

  /// The elements of an accessor whose elements have `size` bytes. For a sparse accessor, the elements of its
  /// buffer view.
  GltfElements elements(const GltfItem& accessor, std::size_t size);

 private:
  void checkSparse(const GltfItem& sparse, std::size_t size);
  GltfElements elements(const GltfItem& item, std::size_t view, std::size_t size, std::size_t count);

  const nlohmann::json& root_;
  GltfBuffers& buffers_;
  const std::string& name_;
};

}  // namespace fcl_stpbv::detail
