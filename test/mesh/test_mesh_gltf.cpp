// glTF that assimp would read as another shape is refused with a message that says what would work. Valid
// glTF is read.
#include <catch2/catch.hpp>
#include <cstdint>
#include <filesystem>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/mesh_file.h"
#include "test/reference/volume_files.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Catch::Matchers::Contains;

namespace {

// One triangle: three vertices, then their indices.
const std::string kTriangleGltf =
    R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],
"buffers":[{"uri":"t.bin","byteLength":42}]})";

template <class T, std::size_t N>
std::string bytesOf(const T (&values)[N]) {
  return std::string(reinterpret_cast<const char*>(values), sizeof values);
}

std::string triangleBytes(std::uint16_t last = 2) {
  const float vertices[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::uint16_t indices[] = {0, 1, last};
  return bytesOf(vertices) + bytesOf(indices);
}

std::string base64(const std::string& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t held = 0;
    for (std::size_t k = 0; k < 3; ++k)
      held = held << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : digits[held >> (18 - 6 * k) & 63];
  }
  return text;
}

std::string chunk(const std::string& kind, const std::string& bytes) {
  const std::uint32_t size[] = {static_cast<std::uint32_t>(bytes.size())};
  return bytesOf(size) + kind + bytes;
}

std::string glb(std::string json, std::string bytes) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
  const std::string chunks = chunk("JSON", json) + chunk(std::string("BIN\0", 4), bytes);
  const std::uint32_t head[] = {2, static_cast<std::uint32_t>(12 + chunks.size())};
  return "glTF" + bytesOf(head) + chunks;
}

struct GltfChange {
  std::string from, to, message;
};

std::string withChange(std::string text, const GltfChange& change) {
  const std::size_t at = text.find(change.from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, change.from.size(), change.to);
}

// Loads a glTF into `mesh`. @returns the error message.
std::string loadedGltf(const std::string& name, const std::string& content, const std::string& bin,
                       TriangleMesh& mesh) {
  const TemporaryFolder folder;
  put(folder / "t.bin", bin);
  put(folder / name, content);
  return refusal([&mesh](const std::string& path) { mesh = loadMesh(path); }, folder / name);
}

void checkGltfRefused(const std::vector<GltfChange>& changes, const std::string& bin = triangleBytes()) {
  for (const GltfChange& change : changes) {
    CAPTURE(change.from, change.to);
    TriangleMesh mesh;
    CHECK_THAT(loadedGltf("t.gltf", withChange(kTriangleGltf, change), bin, mesh),
               Contains("t.gltf: " + change.message));
  }
}

void checkGltfRead(const std::string& name, const std::string& content,
                   const std::string& bin = triangleBytes()) {
  CAPTURE(content);
  TriangleMesh mesh;
  CHECK(loadedGltf(name, content, bin, mesh) == "");
  CHECK(mesh.vertices.size() == 3);
  CHECK(mesh.triangles.size() == 1);
}

}  // namespace

TEST_CASE("glTF: vertices that are no floats and indices that are not unsigned are refused") {
  const std::string vertices = "\"componentType\":5126", indices = "\"componentType\":5123";
  for (const char* type : {"5120", "5121", "5122", "5123", "5125"})
    checkGltfRefused(
        {{vertices, std::string("\"componentType\":") + type, "accessors[0] has the type \"VEC3\""},
         {vertices, std::string("\"normalized\":true,\"componentType\":") + type, "accessors[0] "}});
  checkGltfRefused(
      {{vertices, "\"componenttype\":5126", "accessors[0] has 'componenttype'"},
       {vertices, "\"componentType\":\"5126\"", "accessors[0].componentType must be a whole"},
       {vertices, "\"componentType\":5126.0", "accessors[0].componentType must be a whole"},
       {"\"VEC3\"", "\"VEC2\"", "accessors[0] has the type \"VEC2\""},
       {"\"VEC3\"", "\"vec3\"", "accessors[0] has the type \"vec3\""},
       {",\"type\":\"VEC3\"", "", "accessors[0] has the type none"},
       {"\"POSITION\":0", "\"POSITION_0\":0", "meshes[0].primitives[0].attributes has 'POSITION_0'"},
       {indices, "\"componentType\":5122", "accessors[1] has the type"},
       {indices, "\"componentType\":5126", "accessors[1] has the type"},
       {"\"SCALAR\"", "\"VEC2\"", "accessors[1] has the type"}});
}

TEST_CASE("glTF: a misspelt key, which leads elsewhere or nowhere, is refused") {
  checkGltfRefused({{"\"primitives\"", "\"primitves\"", "meshes[0] has 'primitves'"},
                    {"\"indices\"", "\"indicies\"", "meshes[0].primitives[0] has 'indicies'"},
                    {"\"byteOffset\"", "\"byteoffset\"", "bufferViews[1] has 'byteoffset'"},
                    {"5126,", "5126,\"byteoffset\":0,", "accessors[0] has 'byteoffset'"},
                    {"\"buffers\"", "\"Scene\":0,\"buffers\"", "the document has 'Scene'"},
                    {"\"uri\"", "\"url\":\"\",\"uri\"", "buffers[0] has 'url'"}});
  TriangleMesh mesh;
  const std::size_t at = kTriangleGltf.find("\"primitives\":["), end = kTriangleGltf.find("}]", at);
  REQUIRE(end != std::string::npos);
  const std::string empty = kTriangleGltf.substr(0, at) + "\"primitives\":[" + kTriangleGltf.substr(end + 1);
  CHECK_THAT(loadedGltf("t.gltf", empty, triangleBytes(), mesh), Contains("meshes[0] has no primitives"));
}

TEST_CASE("glTF: a mesh that its nodes bring back from far away is refused") {
  const auto moved = [](const std::string& far, const std::string& back) {
    const std::string node = "\"nodes\":[{\"mesh\":0";
    REQUIRE(kTriangleGltf.find(node) != std::string::npos);
    TriangleMesh mesh;
    return loadedGltf("t.gltf",
                      withChange(kTriangleGltf, {node,
                                                 "\"nodes\":[{\"children\":[1],\"translation\":[" + far +
                                                     ",0,0]},{\"mesh\":0,\"translation\":[" + back + ",0,0]",
                                                 ""}),
                      triangleBytes(), mesh);
  };
  CHECK(moved("100.03", "-100") == "");
  for (const char* far : {"1e4", "1000000.03", "-1e7"})
    CHECK_THAT(moved(far, far[0] == '-'   ? "1e7"
                          : far[2] == '4' ? "-1e4"
                                          : "-1000000"),
               Contains("is too far from its origin"));
}

TEST_CASE("glTF: what reaches past an end is refused") {
  checkGltfRefused(
      {{"5126,\"count\":3", "5126,\"count\":2", "accessors[1] names vertex 2 of accessors[0], which has 2"},
       {"5126,\"count\":3", "5126,\"count\":4", "accessors[0] takes 48 bytes from bufferViews[0]"},
       {"5126,", "5126,\"byteOffset\":4,", "accessors[0] takes 40 bytes from bufferViews[0]"},
       {"\"byteLength\":36", "\"byteLength\":36,\"byteStride\":16", "accessors[0] takes 44 bytes"},
       {"\"byteLength\":36", "\"byteLength\":36,\"byteStride\":8", "bufferViews[0] has a byteStride"},
       {"\"byteLength\":6", "\"byteLength\":7", "bufferViews[1] reaches to byte 43 of its buffer"},
       {"\"byteLength\":42", "\"byteLength\":43", "buffers[0] has 42 bytes, but its byteLength is 43"},
       {"t.bin", "u.bin", "buffers[0] is in a file 'u.bin' that cannot be read"},
       {"t.bin", "data:application/octet-stream;base64,AA=A", "buffers[0] is no base64"},
       {"5123,\"count\":3", "5123,\"count\":2", "accessors[1] has 2 indices"}});
  checkGltfRefused({{"", "", "accessors[1] names vertex 3 of accessors[0], which has 3"}}, triangleBytes(3));
}

TEST_CASE("glTF: extensions and deformations that would change the shape are refused") {
  for (const char* extension : {"KHR_mesh_quantization", "EXT_meshopt_compression",
                                "KHR_draco_mesh_compression", "EXT_mesh_gpu_instancing", "VENDOR_unknown"})
    checkGltfRefused({{"{\"asset\"", std::string("{\"extensionsRequired\":[\"") + extension + "\"],\"asset\"",
                       std::string("extensionsRequired[0] is \"") + extension + '"'}});
  const std::string primitive = "\"indices\":1", node = "{\"mesh\":0}";
  checkGltfRefused(
      {{primitive, primitive + ",\"extensions\":{\"KHR_draco_mesh_compression\":{}}",
        "meshes[0].primitives[0] has"},
       {node, "{\"mesh\":0,\"extensions\":{\"EXT_mesh_gpu_instancing\":{}}}", "nodes[0] has the extension"},
       {primitive + "}]", primitive + ",\"targets\":[{\"POSITION\":0}]}],\"weights\":[0,0.5]",
        "meshes[0].weights[1]"},
       {node, "{\"mesh\":0,\"weights\":[1]}", "nodes[0].weights[0] is not 0"},
       {node, "{\"mesh\":0,\"skin\":0}", "nodes[0] has a skin"},
       {"\"version\":\"2.0\"", "\"version\":\"1.0\"", "is glTF of version '1.0'"}});
}

TEST_CASE("glTF: nodes whose transform or children would be taken for others are refused") {
  const std::string node = "{\"mesh\":0}";
  checkGltfRefused(
      {{node, "{\"mesh\":0,\"rotation\":[0,0,1,1]}", "nodes[0].rotation is a quaternion of length 1.41"},
       {node, "{\"mesh\":0,\"rotation\":[0,0,0,0]}", "nodes[0].rotation is a quaternion"},
       {node, "{\"mesh\":0,\"rotation\":[0,0,0.707,0.707]}", "nodes[0].rotation is a quaternion"},
       {node, "{\"mesh\":0,\"rotation\":[0,0,1]}", "nodes[0].rotation must be a list of 4 numbers"},
       {node, "{\"mesh\":0},{\"Mesh\":0}", "nodes[1] has 'Mesh', which is nothing that glTF knows"},
       {node, "{\"mesh\":0,\"scales\":[2,2,2]}", "nodes[0] has 'scales'"},
       {node, "{\"mesh\":0,\"translation\":[1,2]}", "nodes[0].translation must be a list of 3"},
       {node, "{\"mesh\":0,\"translation\":[1,2,\"3\"]}", "nodes[0].translation must be a list of 3"},
       {node, "{\"mesh\":0,\"matrix\":[1]}", "nodes[0].matrix must be a list of 16"},
       {node, "{\"mesh\":0,\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,5,0,0,0,1]}", "nodes[0].matrix must be written"},
       {node, "{\"mesh\":0,\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,2]}", "nodes[0].matrix must be written"},
       {node, "{\"mesh\":0,\"children\":[1.0]},{\"mesh\":0}", "nodes[0].children[0] must be a whole"},
       {"\"nodes\":[0]", "\"nodes\":[0,0.0]", "scenes[0].nodes[1] must be a whole"}});
}

TEST_CASE("glTF: a node that leaves a single point of a mesh is no body of one point") {
  for (const char* node : {"{\"mesh\":0,\"scale\":[0,0,0]}", "{\"mesh\":0,\"scale\":[1e-30,0,0]}",
                           "{\"mesh\":0,\"matrix\":[0,0,0,0,0,0,0,0,0,0,0,0,1,0,0,1]}"})
    checkGltfRefused({{"{\"mesh\":0}", node, "is smaller than 1e-9 m along each axis"}});
}

TEST_CASE("sound glTF is read, whatever its exporter adds") {
  const std::string primitive = "\"indices\":1", asset = "{\"asset\"";
  const std::string data = "data:application/octet-stream;base64," + base64(triangleBytes());
  checkGltfRead("t.glb", glb(withChange(kTriangleGltf, {"\"uri\":\"t.bin\",", "", ""}), triangleBytes()));
  for (const GltfChange& change : std::vector<GltfChange>{
           {"", "", ""},
           {"t.bin", data, ""},
           {",\"indices\":1", "", ""},
           {asset, "{\"extensionsUsed\":[\"VENDOR_unknown\",\"KHR_lights_punctual\"],\"asset\"", ""},
           {asset,
            "{\"extensionsUsed\":[\"KHR_materials_unlit\"],\"extensionsRequired\":[\"KHR_materials_unlit\","
            "\"KHR_texture_transform\"],\"asset\"",
            ""},
           {primitive + "}]", primitive + ",\"targets\":[{\"POSITION\":0}]}],\"weights\":[0]", ""},
           {primitive, primitive + ",\"mode\":5", ""},
           {"{\"mesh\":0}", "{\"mesh\":0,\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}", ""},
           {"{\"mesh\":0}", "{\"mesh\":0,\"rotation\":[0,0,0.707107,0.707107],\"scale\":[2,2,2]}", ""},
           {"5126,\"count\":3",
            "5126,\"count\":3,\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":1,"
            "\"componentType\":5123,\"byteOffset\":4},\"values\":{\"bufferView\":0,"
            "\"byteOffset\":24}}",
            ""}})
    checkGltfRead("t.gltf", withChange(kTriangleGltf, change));
}

TEST_CASE("a glTF's buffer is found by its name, also with the backslashes of Windows and with %20") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "sub of");
  put(folder / "sub of/d.bin", triangleBytes());
  put(folder / "as%20is.bin", triangleBytes());
  put(folder / "\u00fc 100%.bin", triangleBytes());
  for (const char* uri : {"sub of/d.bin", "sub of\\\\d.bin", "as%20is.bin", "./sub of/../as%20is.bin",
                          "sub%20of/d.bin", "sub%20of%2Fd.bin", "sub%20of\\\\d.bin", "%C3%bc%20100%25.bin"}) {
    CAPTURE(uri);
    put(folder / "t.gltf", withChange(kTriangleGltf, {"t.bin", uri, ""}));
    CHECK(loadPoints(folder / "t.gltf").size() == 3);
  }
  std::filesystem::create_directory(folder / "in");
  put(folder / "in/t.gltf", withChange(kTriangleGltf, {"t.bin", "%2e%2e/as%20is.bin", ""}));
  CHECK_THROWS_WITH(loadPoints(folder / "in/t.gltf"), Contains("cannot be read"));
}

TEST_CASE("a GLB that is cut off or has another version is refused") {
  const std::string whole = glb(withChange(kTriangleGltf, {"\"uri\":\"t.bin\",", "", ""}), triangleBytes());
  for (std::size_t size = 4; size < whole.size(); size += 7) {
    TriangleMesh mesh;
    CHECK_THAT(loadedGltf("t.glb", whole.substr(0, size), "", mesh), Contains("t.glb: "));
  }
  std::string old = whole;
  old[4] = 1;
  TriangleMesh mesh;
  CHECK_THAT(loadedGltf("t.glb", old, "", mesh), Contains("t.glb: is no GLB of version 2"));
}

TEST_CASE("a GLB with bytes in another file is told to hold them itself") {
  TriangleMesh mesh;
  const std::string two = withChange(kTriangleGltf, {"\"buffer\":0", "\"buffer\":1", ""});
  CHECK_THAT(
      loadedGltf("t.glb",
                 glb(withChange(two, {":[{\"uri", ":[{\"byteLength\":42},{\"uri", ""}), triangleBytes()),
                 triangleBytes(), mesh),
      Contains("buffers[1] is in a file 't.bin', which only a .gltf may have; export the mesh as one .glb"));
}
