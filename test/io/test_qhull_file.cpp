// Clouds of points in qhull's formats.
#include <catch2/catch.hpp>
#include <filesystem>

#include "fcl_stpbv/io/volume_files.h"
#include "fcl_stpbv/volume/stp_bv.h"
#include "test/reference/volume_files.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

namespace {

const std::string kPolyhedron =
    "3\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1.5e0\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\nVertices and facets:\n- "
    "f1\n";
const std::string kPoints = "3 rbox 4\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1.5\n";

std::vector<Eigen::Vector3d> parsed(const std::string& text) { return parseQhullPoints(text, "file"); }

}  // namespace

TEST_CASE("qhull polyhedra and point files give their points") {
  const std::vector<Eigen::Vector3d> expected{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1.5}};
  CHECK(parsed(kPolyhedron) == expected);
  CHECK(parsed(kPoints) == expected);
  CHECK(looksLikeQhull(kPolyhedron));
  CHECK(looksLikeQhull(kPoints));
  CHECK_FALSE(looksLikeQhull("0.2 300\n8\n"));
  CHECK_FALSE(looksLikeQhull("1 10\n8\n"));
  for (const std::string first : {"3 -1 -2", "3 .5 1", "3 +1 2", "3 1e3 2"})  // a line of points
    CHECK_FALSE(looksLikeQhull(first + "\n4 0 0\n0 0 0\n"));
  CHECK_FALSE(looksLikeQhull("stpbv 1\n"));
  CHECK_FALSE(looksLikeQhull(""));
}

TEST_CASE("a qhull file cut off before the end of its facets is refused") {
  const std::size_t facetsEnd = kPolyhedron.find("\nVertices");
  for (std::size_t length = 0; length < facetsEnd; ++length) {
    INFO(kPolyhedron.substr(0, length));
    CHECK(refusal(parsed, kPolyhedron.substr(0, length)).find("file:") == 0);
  }
}

TEST_CASE("damaged qhull files are refused with the line") {
  const auto check = [](const std::string& text, const std::string& place, const std::string& expected) {
    const std::string message = refusal(parsed, text);
    INFO(message);
    CHECK(message.find(place) == 0);
    CHECK(message.find(expected) != std::string::npos);
  };
  check("2\n4\n0 0\n1 0\n0 1\n1 1\n", "file:1:", "expected 3");
  check("3\n1000000000\n0 0 0\n", "file:2:", "can contain");
  check("3\n0\n", "file:2:", "from 1");
  check("3\n1\n0 nan 0\n", "file:3:", "finite");
  check("3\n1\n0 +-1 0\n", "file:3:", "finite");
  check("3\n2 1000000000 1\n0 0 0\n1 1 1\n", "file:2:", "can contain");
  check("3\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "file:6:", "from 0 to 2");
  check("3\n1\n0 0 0\n1 1 1\n", "file:4:", "end of the file");
  check("0.2 300\n8\n", "file:1:", "dimension");
}

TEST_CASE("the humanoid's polyhedra all become volumes") {
  const std::string folder = sharedFolder("robots/jvrc_description/convex/jvrc1");
  if (folder.empty()) {
    WARN("skipped: ../shared/robots is missing");
    return;
  }
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    INFO(entry.path().string());
    CHECK(StpBv::build(loadQhullPoints(entry.path().string()))->faceCount() > 3);
    ++count;
  }
  CHECK(count == 35);
}
