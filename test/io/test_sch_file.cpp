// sch-core's format: files written by the library mean the same to the format's reader, files of others load,
// and damaged files are refused.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <sstream>

#include "fcl_stpbv/io/sch_data.h"
#include "fcl_stpbv/io/volume_files.h"
#include "fcl_stpbv/volume/measure.h"
#include "test/reference/shapes.h"
#include "test/reference/volume_files.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;

namespace {

const char* const kSamples[] = {"cube2x2.txt", "s2x2.txt", "sample_stp_p.txt", "sample_stpbv1.txt",
                                "sample_stpbv2.txt"};

std::string asSch(const StpBv& volume) {
  std::ostringstream out;
  saveSch(out, volume);
  return out.str();
}

StpBv::Ptr fromSch(const std::string& text) {
  std::istringstream in(text);
  return loadSch(in, "file");
}

// The support function as a reader of the format computes it: from the file's numbers, in the feature whose
// borders contain the direction best.
class Reader {
 public:
  explicit Reader(const std::string& text) : file_(sch::parse(text, "file")) {}

  double support(const Vector3d& v) {
    worst_ = std::numeric_limits<double>::infinity();
    for (const sch::Vertex& vertex : file_.vertices) {
      double outside = -1;
      for (const sch::Border& cone : vertex.tori) outside = std::max(outside, cone.cosine - v.dot(cone.axis));
      take(outside, v.dot(vertex.centre) + vertex.radius);
    }
    for (const sch::Face& face : file_.faces) {
      double outside = -1;
      for (const sch::Border& side : face.side) outside = std::max(outside, -v.dot(side.axis));
      take(outside, v.dot(face.centre) + face.radius);
    }
    for (const sch::Torus& torus : file_.tori) {
      if (!torus.real) continue;
      double outside = -1;
      for (const sch::Border& cone : torus.cone) outside = std::max(outside, v.dot(cone.axis) - cone.cosine);
      for (const sch::Border& plane : torus.plane) outside = std::max(outside, v.dot(plane.axis));
      const double along = v.dot(torus.axis);
      take(outside,
           v.dot(torus.middle) - torus.circle * std::sqrt(std::max(0.0, 1 - along * along)) + torus.tube);
    }
    return best_;
  }

  /// How far the last direction is outside of its feature. It is at most rounding if the features tile the
  /// sphere.
  double outside() const { return worst_; }

  /// Rounding of a support value by the file's digits: that of a sum of numbers as large as a face's centre
  /// and radius.
  double rounding() const {
    double farthest = 0;
    for (const sch::Face& face : file_.faces) farthest = std::max(farthest, face.centre.norm());
    return 4 * file_.rounding() * (farthest + file_.R);
  }

 private:
  void take(double outside, double value) {
    if (outside < worst_) worst_ = outside, best_ = value;
  }

  sch::File file_;
  double worst_ = 0, best_ = 0;
};

std::string replacedAt(std::string text, std::size_t token, const std::string& with) {
  std::size_t at = 0;
  const char* const blanks = " \n\r\t";
  for (std::size_t i = 0;; ++i) {
    at = text.find_first_not_of(blanks, at);
    REQUIRE(at != std::string::npos);
    const std::size_t end = std::min(text.find_first_of(blanks, at), text.size());
    if (i == token) return text.replace(at, end - at, with);
    at = end;
  }
}

std::size_t tokens(const std::string& text) {
  std::istringstream in(text);
  std::string token;
  std::size_t count = 0;
  while (in >> token) ++count;
  return count;
}

}  // namespace

TEST_CASE("a volume through sch-core's format is the same bit by bit") {
  for (const auto& [name, volume] : volumesForSch()) {
    INFO(name);
    const std::string text = asSch(*volume);
    CHECK(looksLikeSch(text));
    const StpBv::Ptr back = fromSch(text);
    CHECK(back->vertices() == volume->vertices());
    CHECK(back->faces() == volume->faces());
    CHECK(asSch(*back) == text);
    CHECK(verify(*back).ok);
  }
}

TEST_CASE("sch-core's files are known by their first lines, however many vertices follow") {
  for (const std::string text :
       {"0.2 300\n 8\n", "0.2 300\r\n 8 \r\n", "0.2\n300\n8\n", "0 10\n2000000000\n", "0 10\n8"})
    CHECK(looksLikeSch(text));
  for (const std::string text : {"10 20 30\n11 20 30\n", "0 1 2\n", "0 10\n8 0 0\n", "0 10\n0\n", "10 1\n8\n",
                                 "-1 1\n8\n", "0 10\n8.5\n", "0 10\n", ""}) {
    INFO(text);
    CHECK_FALSE(looksLikeSch(text));
  }
}

TEST_CASE("a written file means the same surface to a reader of its numbers") {
  for (const auto& [name, volume] : volumesForSch()) {
    INFO(name);
    Reader reader(asSch(*volume));
    const double rounding = 1e-15 * 4 * (volume->radii().R + volume->centre().norm());
    Random random(3);
    for (int i = 0; i < 1000; ++i) {
      const Vector3d n = random.direction();
      CHECK(std::abs(reader.support(n) - volume->support(n)) <= rounding);
      CHECK(reader.outside() < 1e-12);
    }
  }
}

TEST_CASE("files of sch-creator load, with the surface they describe within their digits") {
  const std::string folder = sharedFolder("sch_samples");
  if (folder.empty()) {
    WARN("skipped: ../shared/sch_samples is missing");
    return;
  }
  for (const char* const sample : kSamples) {
    INFO(sample);
    Reader reader(contentOf(folder + "/" + sample));
    const StpBv::Ptr volume = loadSch(folder + "/" + sample);
    const StpBv::Ptr rebuilt = StpBv::build(volume->vertices(), {volume->radii().r, volume->radii().R});
    CHECK(verify(*volume).ok);
    Random random(4);
    double worst = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vector3d n = random.direction();
      const double claimed = reader.support(n);
      worst = std::max(worst, std::abs(claimed - volume->support(n)));
      worst = std::max(worst, std::abs(claimed - rebuilt->support(n)));
    }
    CHECK(worst <= reader.rounding());
    // The text written by the library reads back exactly.
    CHECK(fromSch(asSch(*volume))->vertices() == volume->vertices());
  }
}

TEST_CASE("a volume that the format cannot represent is reported, not written") {
  const TemporaryFolder folder;
  const auto save = [&](const StpBv::Ptr& volume) {
    return refusal([&](const std::string& path) { saveSch(path, *volume); }, folder / "a.txt");
  };
  CHECK(save(StpBv::build({{0, 0, 0}})).find("one or two vertices") != std::string::npos);
  CHECK(save(StpBv::build({{0, 0, 0}, {1, 0, 0}})).find("one or two vertices") != std::string::npos);
  CHECK(save(StpBv::build({{0, 0, 0}, {1, 0, 0}, {0.5, 0.1, 0}})).find("more than half a turn") !=
        std::string::npos);
  CHECK(folder.files().empty());
}

TEST_CASE("a file of sch-core's cut off anywhere is refused") {
  const std::string text = asSch(*StpBv::build(box(0.2, 0.3, 0.5)));
  const std::size_t lastToken = text.find_last_of(' ');
  for (std::size_t length = 0; length <= lastToken; ++length) {
    INFO(length);
    CHECK(refusal(fromSch, text.substr(0, length)).find("file:") == 0);
  }
  const std::string folder = sharedFolder("sch_samples");
  for (const char* const sample : kSamples) {
    if (folder.empty()) break;
    const std::string whole = contentOf(folder + "/" + sample);
    CHECK(refusal(fromSch, whole.substr(0, whole.size() / 2)).find("file:") == 0);
  }
}

TEST_CASE("a number changed anywhere is refused") {
  const std::string text = asSch(*StpBv::build(box(0.2, 0.3, 0.5)));
  const std::size_t count = tokens(text);
  std::string accepted;
  for (std::size_t token = 0; token < count; ++token) {
    for (const char* const other : {"0.017", "5", "-1", "1000000000", "nan", "x"}) {
      const std::string damaged = replacedAt(text, token, other);
      if (damaged == text) continue;
      const std::string message = refusal(fromSch, damaged);
      if (message.find("file:") != 0) accepted += std::to_string(token) + " -> " + other + "\n";
    }
  }
  CHECK(accepted == "");
}

TEST_CASE("a file of sch-core's with flipped bits is refused or still holds a volume") {
  Random random(43);
  const std::string texts[] = {asSch(*StpBv::build(box(0.2, 0.3, 0.5))),
                               asSch(*StpBv::build(randomHull(30, {0.1, 0.2, 0.3}, 3), {0.01, 2}))};
  for (int i = 0; i < 2000; ++i) {
    std::string text = texts[i % 2];
    char& c = text[static_cast<std::size_t>(random.below(static_cast<int>(text.size())))];
    c = static_cast<char>(c ^ (1 << random.below(8)));
    try {
      const StpBv::Ptr volume = fromSch(text);
      CHECK(verify(*volume).ok);
    } catch (const Error& error) {
      CHECK(std::string(error.what()).find("file") == 0);
    }
  }
}

TEST_CASE("damaged fields of sch-core's format are refused with their line") {
  const std::string text = asSch(*StpBv::build(box(0.2, 0.3, 0.5)));
  const auto check = [&](std::size_t token, const std::string& with, const std::string& place,
                         const std::string& expected) {
    const std::string message = refusal(fromSch, replacedAt(text, token, with));
    INFO(message);
    CHECK(message.find(place) == 0);
    CHECK(message.find(expected) != std::string::npos);
  };
  check(0, "-1", "file:1:", "0 <= r < R");
  check(2, "1000000000", "file:2:", "can contain");
  check(3, "0.02", "file:3:", "radius");
  check(7, "4", "file:", "");
  check(8, "7", "file:3:", "no torus");
  check(10, "0.5", "file:3:", "unit vector");
}

TEST_CASE("sides that pass their ball's centre, near the smallest R, are read back") {
  const std::vector<Eigen::Vector3d> square{
      {0.1, 0.2, 0.3}, {0.7, 0.2, 0.3}, {0.7, 0.8, 0.3}, {0.1, 0.8, 0.3}};
  for (const double beyond : {1e-12, 1e-10, 1e-8, 1e-6, 1e-3}) {
    std::stringstream file;
    saveSch(file, *StpBv::build(square, {0.01, StpBv::smallestR(square, 0.01) * (1 + beyond)}));
    CAPTURE(beyond);
    CHECK_NOTHROW(loadSch(file));
  }
}
