// Checks the meshes and nodes of a glTF document. assimp copies the bytes of vertices as floats whatever
// their type is, leaves out triangles with wrong indices, and knows few extensions.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/gltf_values.h"
#include "fcl_stpbv/mesh/json_text.h"
#include "fcl_stpbv/mesh/mesh_checks.h"
#include "fcl_stpbv/words.h"

namespace fcl_stpbv::detail {
namespace {

constexpr std::size_t kByte = 5121, kShort = 5123, kInt = 5125, kFloat = 5126;
constexpr std::size_t kLargestMode = 6, kTriangleList = 4;

// Tolerance for the length of a quaternion, because assimp makes its matrix without normalising it. Such an
// error stretches the body by 0.002 %. Quaternions with six digits keep the tolerance.
constexpr double kUnit = 1e-5;

// Extensions that change no vertex, besides KHR_materials_...
bool isHarmless(std::string_view extension) {
  constexpr Words kOthers{"EXT_lights_ies",        "EXT_lights_image_based", "EXT_texture_avif",
                          "EXT_texture_webp",      "KHR_lights_punctual",    "KHR_texture_basisu",
                          "KHR_texture_transform", "KHR_techniques_webgl",   "KHR_xmp",
                          "KHR_xmp_json_ld",       "MSFT_texture_dds"};
  constexpr std::string_view kMaterials = "KHR_materials_";
  return extension.substr(0, kMaterials.size()) == kMaterials || holds(kOthers, extension);
}

class GltfCheck {
 public:
  GltfCheck(const nlohmann::json& root, GltfBuffers& buffers, const std::string& name)
      : root_(root), name_(name), values_(root, buffers, name) {}

  void check() {
    checkVersion();
    checkExtensions();
    checkKeys();
    for (const GltfItem& mesh : values_.list("meshes")) {
      requireKeys(mesh, {"primitives", "weights"});
      checkWeights(mesh);
      const std::vector<GltfItem> primitives = values_.list(mesh, "primitives");
      if (primitives.empty()) values_.damaged(mesh, "has no primitives, which are what a mesh is made of");
      for (const GltfItem& primitive : primitives) checkPrimitive(primitive);
    }
    for (const GltfItem& node : values_.list("nodes")) checkNode(node);
    for (const GltfItem& scene : values_.list("scenes")) {
      requireKeys(scene, {"nodes"});
      for (const GltfItem& node : values_.list(scene, "nodes")) values_.whole(node);
    }
  }

 private:
  void checkVersion() const {
    const auto asset = root_.find("asset");
    std::string version;
    if (asset != root_.end() && asset->is_object() && asset->contains("version") &&
        (*asset)["version"].is_string())
      version = (*asset)["version"];
    if (version.substr(0, 1) != "2")
      throw Error(name_ + ": is glTF of version '" + version +
                  "'; export it as glTF 2.0, the one that is read");
  }

  void checkExtensions() const {
    for (const GltfItem& required : values_.list("extensionsRequired")) {
      if (required.value->is_string() && isHarmless(required.value->get_ref<const std::string&>())) continue;
      values_.refuse(required, "is " + required.value->dump() +
                                   ", which is not read; export the mesh without that extension, neither "
                                   "compressed nor quantized nor instanced");
    }
  }

  // assimp uses the mesh's shape with all weights at 0.
  void checkWeights(const GltfItem& item) const {
    for (const GltfItem& weight : values_.list(item, "weights"))
      if (!weight.value->is_number() || weight.value->get<double>() != 0)
        values_.refuse(weight, "is not 0, but morph targets are not read; export the mesh with them applied");
  }

  void checkPrimitive(const GltfItem& primitive) {
    requireKeys(primitive, {"attributes", "indices", "material", "mode", "targets"});
    refuseExtension(primitive, "KHR_draco_mesh_compression", "export the mesh without compression");
    const std::optional<GltfItem> attributes = values_.find(primitive, "attributes");
    if (!attributes || !attributes->value->is_object())
      values_.damaged(primitive, "must have attributes, among them POSITION");
    for (const auto& [attribute, ignored] : attributes->value->items())
      if (attribute.substr(0, 8) == "POSITION" && attribute != "POSITION")
        values_.refuse(*attributes, "has '" + attribute + "', expected POSITION");
    const GltfItem positions = values_.at("accessors", values_.whole(*attributes, "POSITION"));
    requireType(positions, "VEC3", {kFloat},
                "5126 (float), for vertices; export the mesh without quantization");
    values_.elements(positions, 3 * sizeof(float));
    const std::size_t vertices = values_.whole(positions, "count");
    const std::size_t mode = values_.whole(primitive, "mode", kTriangleList);
    if (mode > kLargestMode) values_.damaged(primitive, "must have a mode from 0 to 6");
    const std::optional<GltfItem> indices = values_.find(primitive, "indices");
    if (!indices) return;  // without indices, vertices of an incomplete triangle are counted too
    const GltfItem accessor = values_.at("accessors", values_.whole(*indices));
    checkIndices(accessor, vertices, positions.place);
    const std::size_t corners = values_.whole(accessor, "count");
    if ((mode == kTriangleList && corners % 3 != 0) || (mode > kTriangleList && corners < 3))
      values_.damaged(accessor, "has " + std::to_string(corners) + " indices, which make no whole triangles");
  }

  void requireType(const GltfItem& accessor, const std::string& type,
                   const std::vector<std::size_t>& components, const std::string& expected) const {
    const std::optional<GltfItem> own = values_.find(accessor, "type");
    const std::size_t component = values_.whole(accessor, "componentType");
    if (own && *own->value == type &&
        std::find(components.begin(), components.end(), component) != components.end())
      return;
    values_.refuse(accessor, "has the type " + (own ? own->value->dump() : "none") + " of componentType " +
                                 std::to_string(component) + ", expected \"" + type + "\" of " + expected);
  }

  void checkIndices(const GltfItem& accessor, std::size_t vertices, const std::string& positions) {
    requireType(accessor, "SCALAR", {kByte, kShort, kInt},
                "5121, 5123 or 5125 (unsigned), for indices; export the mesh again");
    if (values_.find(accessor, "sparse"))
      values_.refuse(accessor, "is sparse, which is not read of indices; export the mesh without");
    const std::size_t component = values_.whole(accessor, "componentType");
    const GltfElements indices = values_.elements(accessor, component == kByte    ? 1
                                                            : component == kShort ? 2
                                                                                  : 4);
    for (std::size_t i = 0; i < indices.count; ++i)
      if (indices.number(i) >= vertices)
        values_.damaged(accessor, "names vertex " + std::to_string(indices.number(i)) + " of " + positions +
                                      ", which has " + std::to_string(vertices) + ", the first being 0");
  }

  // Checks the keys of objects that the other checks only look up.
  void checkKeys() const {
    requireKeys({&root_, "the document"},
                {"accessors", "animations", "asset", "buffers", "bufferViews", "cameras", "images",
                 "materials", "meshes", "nodes", "samplers", "scene", "scenes", "skins", "textures",
                 "extensionsUsed", "extensionsRequired"});
    for (const GltfItem& accessor : values_.list("accessors"))
      requireKeys(accessor, {"bufferView", "byteOffset", "componentType", "normalized", "count", "type",
                             "max", "min", "sparse"});
    for (const GltfItem& view : values_.list("bufferViews"))
      requireKeys(view, {"buffer", "byteOffset", "byteLength", "byteStride", "target"});
    for (const GltfItem& buffer : values_.list("buffers")) requireKeys(buffer, {"byteLength", "uri"});
  }

  // With a misspelt key, a body would be missing, be at a wrong place, or have the data of another one.
  void requireKeys(const GltfItem& item, const Words& keys) const {
    constexpr Words kAnywhere{"extensions", "extras", "name"};
    if (!item.value->is_object()) return;  // the object's reader refuses it
    for (const auto& [key, ignored] : item.value->items())
      if (!holds(keys, key) && !holds(kAnywhere, key))
        values_.refuse(item, "has '" + key + "', which is nothing that glTF knows there");
  }

  void checkNode(const GltfItem& node) const {
    requireKeys(node, {"camera", "children", "matrix", "mesh", "rotation", "scale", "translation", "skin",
                       "weights"});
    refuseExtension(node, "EXT_mesh_gpu_instancing", "export a node for each instance");
    if (values_.find(node, "mesh") && values_.find(node, "skin"))
      values_.refuse(node,
                     "has a skin, which moves vertices and is not read; export the mesh with it applied");
    checkWeights(node);
    for (const GltfItem& child : values_.list(node, "children")) values_.whole(child);
    if (const std::optional<GltfItem> matrix = values_.find(node, "matrix")) checkMatrix(*matrix);
    for (const char* key : {"translation", "scale"})
      if (const std::optional<GltfItem> vector = values_.find(node, key)) values_.numbers(*vector, 3);
    if (const std::optional<GltfItem> rotation = values_.find(node, "rotation")) {
      const std::vector<double> q = values_.numbers(*rotation, 4);
      const double length = std::sqrt(std::inner_product(q.begin(), q.end(), q.begin(), 0.0));
      if (!(std::abs(length - 1) <= kUnit))
        values_.refuse(*rotation, "is a quaternion of length " + std::to_string(length) +
                                      ", expected 1; export the mesh again, with at least six digits");
    }
  }

  // assimp leaves out the last row of a matrix. In a matrix written row by row, that row has the translation.
  void checkMatrix(const GltfItem& matrix) const {
    const std::vector<double> m = values_.numbers(matrix, 16);
    if (!(m[3] == 0 && m[7] == 0 && m[11] == 0 && m[15] == 1))
      values_.damaged(matrix, "must be written column by column, each ending in 0 but the last in 1");
  }

  void refuseExtension(const GltfItem& item, const char* extension, const std::string& instead) const {
    const std::optional<GltfItem> extensions = values_.find(item, "extensions");
    if (extensions && values_.find(*extensions, extension))
      values_.refuse(item, std::string("has the extension ") + extension + ", which is not read; " + instead);
  }

  const nlohmann::json& root_;
  const std::string& name_;
  GltfValues values_;
};

}  // namespace

void checkGltf(std::string_view text, const std::string& name, const ReadPart& readPart) {
  const GltfText parts = splitGltf(text, name);
  const nlohmann::json root = parseJson(std::string(parts.json), name);
  if (!root.is_object()) throw Error(name + ": is no glTF, whose JSON is an object in braces");
  GltfBuffers buffers(root, parts, readPart, name);
  GltfCheck(root, buffers, name).check();
}

}  // namespace fcl_stpbv::detail
