// A mesh that somebody saves while a robot is loaded: nothing wrong comes out, and nothing wrong stays in the
// cache.
#include <catch2/catch.hpp>
#include <filesystem>
#include <set>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/mesh_file.h"
#include "fcl_stpbv/mesh/passing_error.h"
#include "fcl_stpbv/robot/geometry_steps.h"
#include "fcl_stpbv/robot/keyed_mesh.h"
#include "test/reference/solids.h"
#include "test/reference/volume_files.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

const std::string kChanged = "changed while it was read; run again";

// A robot of one link, whose mesh is an L.
RobotModel oneLink(const TemporaryFolder& folder) {
  saveMesh(folder / "m.obj", lShape());
  put(folder / "r.urdf", robot(link("a", "<mesh filename=\"m.obj\"/>")));
  return loadUrdf(folder / "r.urdf");
}

void saveBox(const TemporaryFolder& folder) {
  saveMesh(folder / "m.obj", boxMesh({0, 0, 0}, {0.1, 0.1, 0.1}));
}

std::set<std::string> entriesOf(const std::string& folder) {
  std::set<std::string> found;
  for (const auto& entry : fs::directory_iterator(folder)) found.insert(entry.path().string());
  return found;
}

GeometryOptions withCache(const std::string& folder) {
  GeometryOptions options;
  options.cacheFolder = folder;
  return options;
}

// Saves a glTF of one triangle, with its corners in a file beside it.
void saveGltf(const TemporaryFolder& folder, float x) {
  const float corners[] = {0, 0, 0, x, 0, 0, 0, 1, 0};
  put(folder / "t.bin", std::string(reinterpret_cast<const char*>(corners), sizeof corners));
  put(folder / "t.gltf",
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"uri":"t.bin","byteLength":36}]})");
}

}  // namespace

TEST_CASE("parts of a mesh that was saved meanwhile are refused, and nothing of it is kept") {
  const TemporaryFolder folder;
  const GeometryOptions options = withCache(folder / "cache");
  const RobotModel model = oneLink(folder);
  const auto whole = std::make_shared<const RobotGeometry>(loadGeometry(model, options));
  const std::set<std::string> before = entriesOf(options.cacheFolder);
  saveBox(folder);
  CHECK_THROWS_WITH(LinkParts(whole, options.cacheFolder).of(0, 4), folder / "m.obj" + ": " + kChanged);
  CHECK(entriesOf(options.cacheFolder) == before);
  saveMesh(folder / "m.obj", lShape());
  const std::vector<Body> kept = LinkParts(whole, options.cacheFolder).of(0, 4);
  const std::vector<Body> fresh = LinkParts(whole, "").of(0, 4);
  REQUIRE(kept.size() == fresh.size());
  for (std::size_t i = 0; i < kept.size(); ++i) CHECK(kept[i].hull == fresh[i].hull);
}

TEST_CASE("points of a mesh that was saved meanwhile are refused, also if wrong shapes are left out") {
  const TemporaryFolder folder;
  const GeometryOptions options = withCache(folder / "cache");
  const RobotModel model = oneLink(folder);
  loadGeometry(model, options);
  for (const std::string& entry : entriesOf(options.cacheFolder))
    if (entry.find("over-cover") != std::string::npos) fs::remove(entry);  // so that the points are read
  const std::set<std::string> before = entriesOf(options.cacheFolder);
  LoadFaults faults;
  const ShapeSources sources = readGeometry(model, options, faults);
  saveBox(folder);
  CHECK_THROWS_AS(buildGeometry(model, options, sources, faults), PassingError);
  CHECK(faults.shapes.empty());
  CHECK(entriesOf(options.cacheFolder) == before);
}

TEST_CASE("the volume of a mesh that was saved after its key was read is that of the key") {
  const TemporaryFolder folder;
  const GeometryOptions options = withCache(folder / "cache");
  const RobotModel model = oneLink(folder);
  LoadFaults faults;
  const ShapeSources sources = readGeometry(model, options, faults);
  saveBox(folder);
  buildGeometry(model, options, sources, faults);
  saveMesh(folder / "m.obj", lShape());
  const RobotGeometry kept = loadGeometry(model, options), fresh = loadGeometry(model, withCache(""));
  CHECK(kept.fromCache == 1);
  CHECK(kept.bodies[0].volume->vertices() == fresh.bodies[0].volume->vertices());
}

TEST_CASE("a glTF has changed if the file with its vertices has") {
  const TemporaryFolder folder;
  saveGltf(folder, 1);
  const KeyedMesh first(folder / "t.gltf", {1, 1, 1});
  CHECK(first.mesh().vertices.size() == 3);
  CHECK(KeyedMesh(folder / "t.gltf", {1, 1, 1}, first.key()).key() == first.key());
  saveGltf(folder, 2);
  CHECK_THROWS_AS(KeyedMesh(folder / "t.gltf", {1, 1, 1}, first.key()), PassingError);
}

TEST_CASE("a glTF's key is not that of a cloud of the same numbers") {
  const TemporaryFolder folder;
  saveGltf(folder, 1);
  put(folder / "t.xyz", "0 0 0\n1 0 0\n0 1 0\n0 1 2\n");  // the corners, and the triangle's three numbers
  CHECK(KeyedMesh(folder / "t.gltf", {1, 1, 1}).key() != KeyedMesh(folder / "t.xyz", {1, 1, 1}).key());
}
