// A link's convex parts are the same from the cache, from any number of threads, and from a single thread.
#include <catch2/catch.hpp>
#include <filesystem>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/mesh_file.h"
#include "fcl_stpbv/parts/parts_text.h"
#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/volume_cache.h"
#include "test/mesh/mesh_reads.h"
#include "test/reference/robots.h"
#include "test/reference/solids.h"
#include "test/reference/volume_files.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

// An L, a bowl and a box, each the mesh of a link.
std::shared_ptr<const RobotGeometry> threeLinks(const TemporaryFolder& folder) {
  saveMesh(folder / "l.obj", lShape());
  saveMesh(folder / "bowl.obj", bowl(0.1, 4));
  saveMesh(folder / "box.obj", boxMesh({0, 0, 0}, {0.1, 0.1, 0.1}));
  std::string text;
  for (const std::string name : {"l", "bowl", "box"})
    text += link(name, "<mesh filename=\"" + name + ".obj\"/>");
  put(folder / "r.urdf", robot(text + joint("j", "fixed", "l", "bowl") + joint("k", "fixed", "bowl", "box")));
  return std::make_shared<const RobotGeometry>(load({"", folder / "r.urdf", "", {}}).geometry);
}

const std::map<int, int> kThree{{0, 3}, {1, 3}, {2, 3}};

std::vector<fs::path> entries(const std::string& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder)) found.push_back(entry.path());
  return found;
}

void checkSame(const RobotGeometry& a, const RobotGeometry& b) {
  REQUIRE(a.bodies.size() == b.bodies.size());
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    CHECK(a.bodies[i].name == b.bodies[i].name);
    CHECK(a.bodies[i].hull == b.bodies[i].hull);
    CHECK(a.bodies[i].excess == b.bodies[i].excess);
    CHECK(a.bodies[i].openExcess == b.bodies[i].openExcess);
    CHECK(a.bodies[i].volume->vertices() == b.bodies[i].volume->vertices());
  }
}

}  // namespace

TEST_CASE("parts are the same by any number of threads, and from the cache without reading a mesh") {
  const TemporaryFolder folder;
  const auto whole = threeLinks(folder);
  const RobotGeometry alone = LinkParts(whole, "").geometry(kThree, {});
  CHECK(alone.bodies.size() > 3 + 3);  // the L and the bowl are split, the box is not
  CHECK(alone.bodies.back().parts == 0);
  LinkParts cold(whole, folder / "cache");
  std::size_t told = 0;
  cold.prepare(kThree, 4, [&](std::size_t done, std::size_t all, const std::string& what) {
    CHECK(done == told++);
    CHECK(all == 3);
    CHECK_THAT(what, Contains("parts of "));
  });
  CHECK(told == 3);
  checkSame(cold.geometry(kThree, {}), alone);
  CHECK(entries(folder / "cache").size() == 3);
  const long before = pagesOfChildren();
  checkSame(LinkParts(whole, folder / "cache").geometry(kThree, {}), alone);
  CHECK(pagesOfChildren() == before);
}

TEST_CASE("a mesh is read once for all numbers of parts") {
  const TemporaryFolder folder;
  LinkParts parts(threeLinks(folder), "");
  CHECK(parts.of(0, 2).size() == 2);
  fs::copy_file(folder / "box.obj", folder / "l.obj", fs::copy_options::overwrite_existing);
  const long before = pagesOfChildren();
  CHECK(parts.of(0, 4).size() >= 2);
  CHECK(pagesOfChildren() == before);
}

TEST_CASE("links of one mesh share its parts, without a cache too") {
  const TemporaryFolder folder;
  saveMesh(folder / "l.obj", lShape());
  const std::string mesh = "<mesh filename=\"l.obj\"/>";
  put(folder / "r.urdf",
      robot(link("left", mesh) + link("right", mesh) + joint("j", "fixed", "left", "right")));
  LinkParts parts(std::make_shared<const RobotGeometry>(load({"", folder / "r.urdf", "", {}}).geometry), "");
  const std::vector<Body>& left = parts.of(0, 2);
  REQUIRE(left.size() == 2);
  const long before = pagesOfChildren();
  const std::vector<Body>& right = parts.of(1, 2);
  CHECK(pagesOfChildren() == before);
  REQUIRE(right.size() == 2);
  CHECK(right[0].hull == left[0].hull);
  CHECK(right[0].link == 1);
  CHECK(right[0].partOf == 1);
}

TEST_CASE(
    "parts have the radii asked for, though the volume of the whole mesh has fewer vertices and a larger r") {
  const TemporaryFolder folder;
  saveMesh(folder / "bowl.obj", bowl(0.1, 4));
  GeometryOptions options;
  options.radii = {0.002, 10};
  options.overCoverBudget = 0.02;
  const std::string mesh = "<mesh filename=\"" + (folder / "bowl.obj") + "\"/>";
  LinkParts parts(std::make_shared<const RobotGeometry>(parsed(robot(link("bowl", mesh)), options).geometry),
                  "");
  const std::vector<Body>& all = parts.of(0, 3);
  REQUIRE(all.size() > 1);
  for (const Body& part : all) {
    CHECK(part.volume->radii().r == 0.002);
    CHECK(part.volume->radii().R == 10);
    CHECK(part.cover.max <= options.overCoverBudget);
  }
}

TEST_CASE("an entry of other parts, a cut one and one that others may write are made anew") {
  const TemporaryFolder folder;
  const TriangleMesh mesh = lShape();
  const auto cached = [&](const std::string& name, double scale) {
    VolumeCache cache(folder / name);
    TriangleMesh scaled = mesh;
    for (Eigen::Vector3d& v : scaled.vertices) v *= scale;
    const ConvexParts parts =
        cache.parts(std::to_string(scale), PartsOptions(), [&] { return convexParts(scaled); });
    CHECK(toText(parts) == toText(convexParts(scaled)));
    return cache.hits() > 0;
  };
  CHECK_FALSE(cached("a", 1));
  CHECK(cached("a", 1));
  CHECK_FALSE(cached("b", 2));
  const std::string entry = entries(folder / "a")[0].string(), other = entries(folder / "b")[0].string();
  const auto spoilt = [&](const auto& spoil) {
    spoil();
    CHECK_FALSE(cached("a", 1));
    CHECK(cached("a", 1));
  };
  spoilt([&] { fs::copy_file(other, entry, fs::copy_options::overwrite_existing); });
  spoilt([&] { fs::resize_file(entry, fs::file_size(entry) - 10); });
  spoilt([&] { fs::permissions(entry, fs::perms::others_write, fs::perm_options::add); });
}

TEST_CASE("a text of parts that was cut off or changed to nonsense is refused") {
  const std::string text = toText(convexParts(lShape()));
  const auto load = [](const std::string& damaged) { partsFromText(damaged, "kept"); };
  CHECK(refusal(load, text).empty());
  for (std::size_t length = 0; length + 1 < text.size(); length += 7)
    CHECK_THAT(refusal(load, text.substr(0, length)), Contains("kept"));
  CHECK_THAT(refusal(load, "parts 999999999" + text.substr(text.find(" pieces"))), Contains("kept"));
  CHECK_THAT(refusal(load, text + "more"), Contains("kept"));
}

TEST_CASE("a mesh that is gone is named") {
  const TemporaryFolder folder;
  LinkParts parts(threeLinks(folder), "");
  fs::remove(folder / "l.obj");
  CHECK_THROWS_WITH(parts.prepare(kThree, 2), Contains("l.obj"));
  CHECK_NOTHROW(parts.of(1, 3));
  for (const int body : {-1, 99}) CHECK_THROWS_WITH(parts.of(body, 3), Contains("there is no body"));
}
