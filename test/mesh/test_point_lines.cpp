// Clouds of points: the endings that name them, and texts with one point a line, sound and damaged.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <regex>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/mesh_file.h"
#include "test/reference/shapes.h"
#include "test/reference/volume_files.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;

namespace {

const std::string kText =
    "# corners of a body (m)\n0 0 0\n+0.3 0 -0\n\n0 3e-1 0 # the third\n\t.0 0. 0.3\r\n";
const std::vector<Vector3d> kPoints{{0, 0, 0}, {0.3, 0, 0}, {0, 0.3, 0}, {0, 0, 0.3}};

// The points by regular expressions and strtod; no value for a text that must be refused.
std::optional<std::vector<Vector3d>> reference(const std::string& text) {
  static const std::regex number(R"([+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?)"), word(R"([^ \t]+)");
  std::vector<Vector3d> points;
  if (text.find('\0') != std::string::npos) return std::nullopt;
  std::size_t start = 0;
  while (start < text.size()) {
    const std::size_t end = std::min(text.find_first_of("\r\n", start), text.size());
    std::string line = text.substr(start, end - start);
    start = end + 1;
    line = line.substr(0, line.find('#'));
    std::vector<double> values;
    for (std::sregex_iterator at(line.begin(), line.end(), word), none; at != none; ++at) {
      const std::string found = at->str();
      if (!std::regex_match(found, number)) return std::nullopt;
      values.push_back(std::strtod(found.c_str(), nullptr));
      if (!std::isfinite(values.back())) return std::nullopt;
    }
    if (values.empty()) continue;
    if (values.size() != 3) return std::nullopt;
    points.emplace_back(values[0], values[1], values[2]);
  }
  if (points.empty()) return std::nullopt;
  return points;
}

}  // namespace

TEST_CASE("a cloud is read under each of its names, with a scale and each point kept") {
  const TemporaryFolder folder;
  const std::string qhull =
      "3 \n4\n0 0 0 \n0.3 0 0 \n0 0.3 0 \n0 0 0.3 \n";  // as sch-creator's scripts write it
  for (const char* ending : {".xyz", ".PTS", ".txt", ""}) {
    put(folder / ("lines" + std::string(ending)), kText);
    CHECK(loadPoints(folder / ("lines" + std::string(ending))) == kPoints);
  }
  for (const char* ending : {".qc", ".cloud", ".otp", ".txt", ""}) {
    put(folder / ("qhull" + std::string(ending)), qhull);
    CHECK(loadPoints(folder / ("qhull" + std::string(ending))) == kPoints);
  }
  put(folder / "twice.xyz", "1 2 4\n1 2 4\n");
  const TriangleMesh twice = loadMesh(folder / "twice.xyz", {1, 2, -0.5});
  CHECK(twice.vertices == std::vector<Vector3d>(2, Vector3d(1, 4, -2)));
  CHECK(twice.triangles.empty());
}

TEST_CASE("a line that is no point is refused with its number") {
  const TemporaryFolder folder;
  const auto check = [&](const std::string& text, const std::string& place, const std::string& says) {
    put(folder / "a.xyz", text);
    const std::string message = refusal([](const std::string& name) { loadPoints(name); }, folder / "a.xyz");
    INFO(message);
    CHECK(message.find("a.xyz" + place) != std::string::npos);
    CHECK(message.find(says) != std::string::npos);
  };
  check("2\nwater\nO 0 0 0\nH 1 0 0\n", ":1: got '2'", "chemistry");
  check("3\n0 0 0\n1 0 0\n0 1 0\n", ":1: got '3'", "remove them");
  check("0 0 0\n1 0\n", ":2: got 2 words", "three coordinates");
  check("0 0 0\n1\n", ":2: got 1 word,", "three coordinates");
  check("0 0 0 0.5 0.5 0.7\n", ":1: got 6 words", "three coordinates");
  check("0 0 0\n\n# x\nO 1 2\n", ":4: got 'O'", "a finite number");
  check("0,0,0\n", ":1: got '0,0,0'", "three coordinates");
  check("0,0 0 0\n", ":1: got '0,0'", "a finite number");
  check("0 0 nan\n", ":1: got 'nan'", "a finite number");
  check("0 0 0x1p3\n", ":1: got '0x1p3'", "a finite number");
  check("0 +-1 0\n", ":1: got '+-1'", "a finite number");
  check("0 0 1e999\n", ":1: got '1e999'", "a finite number");
  check("# nothing\n", ": ", "no points");
  check("", ": ", "no points");
}

TEST_CASE("mutated texts with one point a line give the points they hold, or are refused") {
  const TemporaryFolder folder;
  Random random(41);
  const std::string odd = "0123456789+-.eE# \t\r\nx,;n";
  int read = 0, refused = 0;
  for (int k = 0; k < 3000; ++k) {
    std::string text = kText;
    for (int changes = 1 + static_cast<int>(random.below(3)); changes > 0; --changes) {
      const auto at = static_cast<std::size_t>(random.below(static_cast<int>(text.size())));
      const char letter = odd[static_cast<std::size_t>(random.below(static_cast<int>(odd.size())))];
      const int way = static_cast<int>(random.below(4));
      if (way == 0) text.resize(at);
      if (way == 1) text[at] = letter;
      if (way == 2) text.insert(at, 1, letter);
      if (way == 3) text[at] = static_cast<char>(text[at] ^ (1 << random.below(7)));
      if (text.empty()) break;
    }
    put(folder / "a.pts", text);
    INFO(text);
    std::optional<std::vector<Vector3d>> found;
    const std::string message =
        refusal([&](const std::string& name) { found = loadPoints(name); }, folder / "a.pts");
    CHECK(found == reference(text));
    CHECK(found.has_value() == message.empty());
    ++(found ? read : refused);
  }
  CHECK(read > 300);
  CHECK(refused > 300);
}
