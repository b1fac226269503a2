// Meshes whose content is in memory, as from a pipe: the same as from a file.
#include <catch2/catch.hpp>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/mesh_file.h"
#include "test/reference/source_folder.h"
#include "test/reference/volume_files.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

namespace {

std::string parsing(const std::string& content) {
  return refusal([](const std::string& text) { parseMesh(text, "-"); }, content);
}

}  // namespace

TEST_CASE("a mesh in memory is recognised by its content and is the mesh of the file") {
  const TemporaryFolder folder;
  const TriangleMesh box =
      tessellate(*StpBv::build({{0, 0, 0}, {0.3, 0, 0}, {0, 0.2, 0}, {0, 0, 0.1}}, {0.01, 1}), 0.02);
  std::vector<std::string> files{sourceFolder() + "/data/hrp2_style/meshes/HEAD_LINK1.dae"};
  for (const char* ending : {".obj", ".stl", ".ply", ".glb"}) {
    files.push_back(folder / ("box" + std::string(ending)));
    saveMesh(files.back(), box);
  }
  put(folder / "a.off", "OFF\n4 4 6\n0 0 0\n1 0 0\n0 2 0\n0 0 4\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
  put(folder / "a.stl",
      "solid t\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 2 "
      "1\nendloop\nendfacet\nendsolid t\n");
  put(folder / "a.qc", "3\n3\n0 0 0\n1 0 0\n0 2 0\n");
  put(folder / "a.xyz", "0 0 0\n1 0 0\n0 2 0\n");
  for (const char* name : {"a.off", "a.stl", "a.qc", "a.xyz"}) files.push_back(folder / name);
  for (const std::string& file : files) {
    INFO(file);
    const Eigen::Vector3d scale(1, 2, -0.5);
    const TriangleMesh expected = loadMesh(file, scale), mesh = parseMesh(contentOf(file), "-", scale);
    CHECK(mesh.vertices == expected.vertices);
    CHECK(mesh.triangles == expected.triangles);
  }
}

TEST_CASE("a content that is no mesh is refused by the name given for it") {
  CHECK(parsing("").find("-: is empty") == 0);
  const std::string message = parsing("a text that is no mesh");
  CHECK(message.find("-: cannot be read as a mesh") == 0);
  CHECK(message.find('$') == std::string::npos);  // assimp's own name for what is in memory
  CHECK(parsing("v 0 0 0\nv 1 0 0\nv 0 x 0\nf 1 2 3\n").find("-:3: ") == 0);
  CHECK_THROWS_AS(parseMesh("0 0 0\n", "-", {1, 0, 1}), Error);
}

TEST_CASE("a content opens no file, not even one beside it") {
  const std::string gltf =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,)"
      R"("count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"b.bin"}]})";
  const TemporaryFolder folder;
  put(folder / "b.bin", std::string(36, '\0'));
  put(folder / "m.gltf", gltf);
  CHECK(loadPoints(folder / "m.gltf").size() == 1);
  const std::string message =
      refusal([&](const std::string& text) { parseMesh(text, folder / "m.gltf"); }, gltf);
  CHECK(message.find("b.bin") != std::string::npos);
}
