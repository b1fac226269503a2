// Reads values of a glTF document strictly: a value for which assimp would silently use a default is an
// error.
#include "fcl_stpbv/mesh/gltf_values.h"

#include <algorithm>
#include <utility>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv::detail {
namespace {

// The bound that assimp has too. With it no sum or product here exceeds 64 bits.
constexpr std::size_t kMostWhole = 4294967295u;

std::string indexed(const std::string& place, std::size_t i) { return place + "[" + std::to_string(i) + "]"; }

}  // namespace

std::uint32_t GltfElements::number(std::size_t i) const {
  std::uint32_t value = 0;
  for (std::size_t k = size; k-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[i * stride + k]);
  return value;
}

void GltfValues::refuse(const GltfItem& item, const std::string& message) const {
  throw Error(name_ + ": " + item.place + " " + message);
}

void GltfValues::damaged(const GltfItem& item, const std::string& message) const {
  refuse(item, message + "; the file is damaged, export it again");
}

std::optional<GltfItem> GltfValues::find(const GltfItem& item, const char* key) const {
  if (!item.value->is_object()) damaged(item, "must be an object in braces");
  const auto found = item.value->find(key);
  if (found == item.value->end()) return std::nullopt;
  return GltfItem{&*found, item.place + "." + key};
}

std::vector<GltfItem> GltfValues::list(const GltfItem& item, const char* key) const {
  std::vector<GltfItem> items;
  const std::optional<GltfItem> all = find(item, key);
  if (!all) return items;
  if (!all->value->is_array()) damaged(*all, "must be a list in brackets");
  for (std::size_t i = 0; i < all->value->size(); ++i)
    items.push_back({&(*all->value)[i], indexed(all->place, i)});
  return items;
}

std::vector<GltfItem> GltfValues::list(const char* key) const {
  std::vector<GltfItem> items = list(GltfItem{&root_, ""}, key);
  for (GltfItem& item : items) item.place.erase(0, 1);  // the point before the key
  return items;
}

GltfItem GltfValues::at(const char* key, std::size_t index) const {
  const auto found = root_.find(key);
  const GltfItem item{&root_, indexed(key, index)};
  if (found == root_.end() || !found->is_array() || index >= found->size())
    damaged(item, "is named and does not exist");
  return {&(*found)[index], item.place};
}

std::size_t GltfValues::whole(const GltfItem& item) const {
  if (!item.value->is_number_unsigned() || item.value->get<std::uint64_t>() > kMostWhole)
    damaged(item, "must be a whole number from 0 to " + std::to_string(kMostWhole));
  return item.value->get<std::size_t>();
}

std::size_t GltfValues::whole(const GltfItem& item, const char* key) const {
  const std::optional<GltfItem> member = find(item, key);
  if (!member) damaged(item, std::string("must have a number '") + key + "'");
  return whole(*member);
}

std::size_t GltfValues::whole(const GltfItem& item, const char* key, std::size_t missing) const {
  const std::optional<GltfItem> member = find(item, key);
  return member ? whole(*member) : missing;
}

std::vector<double> GltfValues::numbers(const GltfItem& item, std::size_t count) const {
  std::vector<double> all;
  if (item.value->is_array())
    for (const nlohmann::json& value : *item.value)
      if (value.is_number()) all.push_back(value.get<double>());
  if (all.size() != count || item.value->size() != count)
    damaged(item, "must be a list of " + std::to_string(count) + " numbers");
  return all;
}

GltfElements GltfValues::elements(const GltfItem& accessor, std::size_t size) {
  const std::optional<GltfItem> sparse = find(accessor, "sparse"), view = find(accessor, "bufferView");
  if (sparse) checkSparse(*sparse, size);
  GltfElements all;
  if (view)
    all = elements(accessor, whole(*view), size, whole(accessor, "count"));
  else if (!sparse)
    refuse(accessor, "has no bufferView, so no values; export the mesh again");
  // assimp copies the elements of a sparse accessor packed, but steps through the copy with the view's
  // byteStride.
  if (sparse && view && all.stride != size)
    refuse(*sparse, "with a byteStride is not read; export the mesh without sparse accessors");
  return all;
}

void GltfValues::checkSparse(const GltfItem& sparse, std::size_t size) {
  const std::size_t count = whole(sparse, "count");
  const std::optional<GltfItem> indices = find(sparse, "indices"), values = find(sparse, "values");
  if (!indices || !values) damaged(sparse, "must have indices and values");
  const std::size_t type = whole(*indices, "componentType");
  if (type != 5121 && type != 5123 && type != 5125)
    damaged(*indices, "must have componentType 5121, 5123 or 5125");
  const std::size_t indexSize = type == 5121 ? 1 : type == 5123 ? 2 : 4;
  for (const auto& [item, bytes] : {std::pair(*indices, indexSize), std::pair(*values, size)})
    if (elements(item, whole(item, "bufferView"), bytes, count).stride != bytes)
      refuse(item, "with a byteStride is not read; export the mesh without sparse accessors");
}

GltfElements GltfValues::elements(const GltfItem& item, std::size_t viewIndex, std::size_t size,
                                  std::size_t count) {
  const GltfItem view = at("bufferViews", viewIndex);
  const std::size_t start = whole(view, "byteOffset", 0), length = whole(view, "byteLength");
  const std::string_view buffer = buffers_.bytes(whole(view, "buffer"));
  if (start + length > buffer.size())
    damaged(view, "reaches to byte " + std::to_string(start + length) + " of its buffer, which has " +
                      std::to_string(buffer.size()));
  GltfElements all;
  all.count = count;
  all.size = size;
  all.stride = whole(view, "byteStride", 0);
  if (all.stride == 0) all.stride = size;
  if (all.stride < size)
    damaged(view, "has a byteStride of " + std::to_string(all.stride) + ", but its elements have " +
                      std::to_string(size) + " bytes");
  const std::size_t offset = whole(item, "byteOffset", 0);
  const std::size_t needed = count == 0 ? 0 : offset + (count - 1) * all.stride + size;
  if (needed > length)
    damaged(item, "takes " + std::to_string(needed) + " bytes from " + view.place + ", which has " +
                      std::to_string(length));
  all.bytes = buffer.substr(start, length);
  all.bytes.remove_prefix(std::min(offset, length));
  return all;
}

}  // namespace fcl_stpbv::detail
