// The library's own format: exact, deterministic, and damaged files are refused.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <locale>
#include <sstream>

#include "fcl_stpbv/io/volume_files.h"
#include "fcl_stpbv/volume/measure.h"
#include "test/reference/shapes.h"
#include "test/reference/volume_files.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

namespace {

std::string asStpBv(const StpBv& volume) {
  std::ostringstream out;
  saveStpBv(out, volume);
  return out.str();
}

StpBv::Ptr fromStpBv(const std::string& text) {
  std::istringstream in(text);
  return loadStpBv(in, "file");
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), with);
}

StpBv::Ptr smallBox() { return StpBv::build(box(0.2, 0.3, 0.5)); }

}  // namespace

TEST_CASE("a volume written and read back is the same bit by bit") {
  for (const auto& [name, volume] : volumesOfEveryKind()) {
    INFO(name);
    const std::string text = asStpBv(*volume);
    const StpBv::Ptr back = fromStpBv(text);
    CHECK(back->vertices() == volume->vertices());
    CHECK(back->faces() == volume->faces());
    CHECK(back->radii().r == volume->radii().r);
    CHECK(back->radii().R == volume->radii().R);
    CHECK(asStpBv(*back) == text);
    CHECK(verify(*back).ok);
    Random random(1);
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector3d n = random.direction();
      CHECK(back->support(n) == volume->support(n));
    }
  }
}

TEST_CASE("the locale does not change a file") {
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const StpBv::Ptr volume = StpBv::build(box(0.2, 1000.25, 0.5), {0.01, 2000});
  const std::string text = asStpBv(*volume);
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
  const std::string other = asStpBv(*volume);
  const std::string message = refusal(fromStpBv, other);
  std::locale::global(before);
  CHECK(other == text);
  CHECK(message.empty());
}

TEST_CASE("a file and a stream hold the same") {
  const TemporaryFolder folder;
  const StpBv::Ptr volume = smallBox();
  saveStpBv(folder / "box.stpbv", *volume);
  CHECK(contentOf(folder / "box.stpbv") == asStpBv(*volume));
  CHECK(asStpBv(*loadStpBv(folder / "box.stpbv")) == asStpBv(*volume));
  CHECK(folder.files() == std::vector<std::string>{"box.stpbv"});
}

TEST_CASE("a file cut off anywhere is refused with its line") {
  const std::string text = asStpBv(*smallBox());
  for (std::size_t length = 0; length + 1 < text.size(); ++length) {
    INFO(text.substr(0, length));
    CHECK(refusal(fromStpBv, text.substr(0, length)).find("file:") == 0);
  }
}

TEST_CASE("a file with flipped bits is refused or still holds a volume") {
  Random random(42);
  const std::string texts[] = {asStpBv(*smallBox()),
                               asStpBv(*StpBv::build(randomHull(30, {0.1, 0.2, 0.3}, 3), {0.01, 2}))};
  int refused = 0;
  constexpr int kTries = 3000;
  for (int i = 0; i < kTries; ++i) {
    std::string text = texts[i % 2];
    const int flips = 1 + random.below(3);
    for (int k = 0; k < flips; ++k) {
      char& c = text[static_cast<std::size_t>(random.below(static_cast<int>(text.size())))];
      c = static_cast<char>(c ^ (1 << random.below(8)));
    }
    INFO(text);
    try {
      const StpBv::Ptr volume = fromStpBv(text);
      const Verification verification = verify(*volume);
      INFO(verification.message);
      CHECK(verification.ok);
    } catch (const Error& error) {
      ++refused;
      CHECK(std::string(error.what()).find("file") == 0);
    }
  }
  CHECK(refused > kTries / 2);
}

TEST_CASE("a damaged field is refused with its line and what was expected") {
  const std::string text = asStpBv(*smallBox());
  const auto check = [](const std::string& damaged, const std::string& place, const std::string& expected) {
    const std::string message = refusal(fromStpBv, damaged);
    INFO(message);
    CHECK(message.find(place) == 0);
    CHECK(message.find(expected) != std::string::npos);
  };
  check("", "file:1:", "expected the word 'stpbv'");
  check("solid box\n", "file:1:", "begin with 'stpbv 1'");
  check(replaced(text, "stpbv 1", "stpbv 2"), "file:1:", "reads version 1");
  check(replaced(text, "r 0.01", "r nan"), "file:2:", "finite");
  check(replaced(text, "r 0.01", "r 1e999"), "file:2:", "finite");
  check(replaced(text, "r 0.01", "r 0,01"), "file:2:", "finite");
  check(replaced(text, "r 0.01", "r -0.01"), "file:", "r = -0.01");
  check(replaced(text, "R 10", "R 0.02"), "file:", "smallest usable R");
  check(replaced(text, "vertices 8", "vertices 1000000000"), "file:4:", "can contain");
  check(replaced(text, "vertices 8", "vertices 99999999999999999999"), "file:4:", "whole number");
  check(replaced(text, "vertices 8", "vertices -8"), "file:4:", "whole number");
  check(replaced(text, "vertices 8", "vertices 9"), "file:13:", "vertex coordinate");
  check(replaced(text, "faces 6", "faces 1000000000"), "file:13:", "can contain");
  check(replaced(text, "faces 6", "faces 5"), "file:19:", "expected the word 'end'");
  check(replaced(text, "\n4 ", "\n1000000000 "), "file:14:", "can contain");
  check(replaced(text, "\n4 ", "\n2 "), "file:14:", "from 3");
  check(text + "more", "file:21:", "end of the file");
}

TEST_CASE("an empty name is refused as that, not as a file without a name") {
  const auto load = [](const std::string& path) { loadStpBv(path); };
  const auto save = [](const std::string& path) { saveStpBv(path, *StpBv::build({{0, 0, 0}})); };
  CHECK(refusal(load, "").find("name of a file to read is empty") != std::string::npos);
  CHECK(refusal(save, "").find("name of a file to write is empty") != std::string::npos);
}

TEST_CASE("a missing file and a folder are refused by name") {
  const TemporaryFolder folder;
  const auto load = [](const std::string& path) { loadStpBv(path); };
  CHECK(refusal(load, folder / "none.stpbv") == folder / "none.stpbv: no such file");
  CHECK(refusal(load, folder / "").find("is a folder") != std::string::npos);
}

TEST_CASE("a buffered stream that cannot write is reported") {
  if (!std::filesystem::exists("/dev/full")) return;
  const auto volume = StpBv::build({{0, 0, 0}}, {0.1, 1});
  std::ofstream full("/dev/full");
  CHECK_THROWS_WITH(saveStpBv(full, *volume), Catch::Contains("cannot be written"));
}
