// Reads and writes volumes in sch-core's text format.
// 1. Parse (sch_parse.cpp) and derive the tolerance from the digits in the file.
// 2. Check the redundant data (sch_check.cpp); a contradiction is an error with its line.
// 3. Build a volume from the file's vertices and faces, and compare the faces' reach with it.
#include <cmath>
#include <limits>
#include <numeric>
#include <ostream>
#include <utility>

#include "fcl_stpbv/error_place.h"
#include "fcl_stpbv/io/atomic_write.h"
#include "fcl_stpbv/io/sch_data.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/io/volume_files.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;
using Triangle = std::array<int, 3>;

// A file whose longest number has at least this many digits was not rounded. The shortest exact form of a
// double has up to 17 digits, and of many numbers at least one has 15.
constexpr int kFullDigits = 15;

// The k-gons behind the fans of triangles. The sides between two triangles that name each other are left out.
class Fans {
 public:
  Fans(const sch::File& file, const std::vector<Triangle>& triangles) : file_(file), triangles_(triangles) {
    leader_.resize(triangles.size());
    std::iota(leader_.begin(), leader_.end(), std::size_t{0});
    for (std::size_t f = 0; f < triangles.size(); ++f) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (isInner(f, k)) leader_[leader(index(file.faces[f].side[k].id))] = leader(f);
      }
    }
  }

  std::vector<StpBv::Ring> rings() {
    std::vector<std::vector<std::size_t>> groups(triangles_.size());
    std::vector<std::size_t> order;  // the groups in the order of their first triangles in the file
    for (std::size_t f = 0; f < triangles_.size(); ++f) {
      std::vector<std::size_t>& group = groups[leader(f)];
      if (group.empty()) order.push_back(leader(f));
      group.push_back(f);
    }
    std::vector<StpBv::Ring> rings;
    next_.assign(file_.vertices.size(), -1);
    rings.reserve(order.size());
    for (std::size_t first : order) rings.push_back(ring(groups[first]));
    return rings;
  }

 private:
  std::size_t index(int id) const { return static_cast<std::size_t>(id - file_.firstFace()); }
  bool isInner(std::size_t f, std::size_t k) const { return file_.faces[f].side[k].id < file_.firstTorus(); }

  std::size_t leader(std::size_t f) {
    while (leader_[f] != f) f = leader_[f] = leader_[leader_[f]];
    return f;
  }

  StpBv::Ring ring(const std::vector<std::size_t>& group) {
    std::size_t sides = 0;
    for (std::size_t f : group) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (isInner(f, k)) continue;
        next_[at(triangles_[f][k])] = triangles_[f][(k + 1) % 3];
        ++sides;
      }
    }
    StpBv::Ring ring;
    const int start = triangles_[group[0]][0];
    for (int v = start; v >= 0 && ring.size() < sides;) {
      ring.push_back(v);
      v = std::exchange(next_[at(v)], -1);
      if (v == start) break;
    }
    if (ring.size() != sides) {
      file_.fail(file_.faces[group[0]].line, "the triangles of this face do not make up one polygon");
    }
    return ring;
  }

  const sch::File& file_;
  const std::vector<Triangle>& triangles_;
  std::vector<std::size_t> leader_;
  std::vector<int> next_;  // next vertex along the present ring
};

// Compares the support function of a rebuilt volume with that of the file, for each face, to within the
// file's digits. If the file's value is smaller, a vertex lies outside of one of the file's balls; if it is
// larger, a vertex lies inside.
void compare(const sch::File& file, const StpBv& volume) {
  for (const sch::Face& face : file.faces) {
    const Vector3d middle = (face.corner[0] + face.corner[1] + face.corner[2]) / 3;
    const Vector3d n = (middle - face.centre).normalized();
    const double claimed = n.dot(face.centre) + face.radius;
    constexpr double kSlack = 8;  // for the centre's three coordinates and the radii
    const double tolerance =
        kSlack * file.rounding() * (face.centre.norm() + face.radius + face.corner[0].norm());
    const double off = volume.support(n) - claimed;
    if (std::abs(off) > tolerance) {
      file.fail(face.line, "the volume of the file's vertices is " + toDecimal(off) +
                               " m off this face's sphere; a vertex is missing or damaged");
    }
  }
}

StpBv::Ptr volumeOfSch(const std::string& text, const std::string& name) {
  const sch::File file = sch::parse(text, name);
  const std::vector<Triangle> triangles = sch::check(file);
  const StpBvOptions options{file.r, file.R};
  std::vector<Vector3d> vertices;
  for (const sch::Vertex& vertex : file.vertices) vertices.push_back(vertex.centre);

  StpBv::Ptr volume;
  if (file.digits >= kFullDigits) {
    try {
      volume = StpBv::assemble(vertices, Fans(file, triangles).rings(), options);
    } catch (const Error&) {
      // Another writer may see four points on one ball where we see two triangles, or the other way round.
    }
  }
  if (!volume) volume = within(name, [&] { return StpBv::build(vertices, options); });
  compare(file, *volume);
  return volume;
}

}  // namespace

StpBv::Ptr loadSch(const std::string& path) { return volumeOfSch(readText(path), path); }

StpBv::Ptr loadSch(std::istream& in, const std::string& name) {
  return volumeOfSch(readText(in, name), name);
}

bool looksLikeSch(std::string_view text) {
  TextScanner in(text, "");
  try {
    const double r = in.number(""), R = in.number("");
    const int line = in.line();
    in.integer("", 1, std::numeric_limits<int>::max());
    const bool onItsOwn = in.line() > line && in.restOfLine().find_first_not_of(" \t\r") == std::string::npos;
    return r >= 0 && R > r && onItsOwn;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace fcl_stpbv
