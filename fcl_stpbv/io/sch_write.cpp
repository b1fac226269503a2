// Writes a volume in sch-core's text format: vertices, faces as fans of triangles, tori with their cones and
// planes. Bodies that the format cannot represent are an error, before anything is written.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "fcl_stpbv/error_place.h"
#include "fcl_stpbv/io/atomic_write.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/io/volume_files.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/patch_view.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;

// A rim of half a turn, as a flat right-angled triangle has, is still one region. The 1e-9 is for rounding.
constexpr double kHalfTurn = kPi + 1e-9;

void requireWritable(const StpBv& volume) {
  if (volume.faceCount() == 0) {
    throw Error(
        "an STP-BV of one or two vertices has no face, which sch-core's format cannot hold; use the format "
        "stpbv");
  }
  for (const StpBv::Edge& edge : volume.edges()) {
    if (edge.turn <= kHalfTurn) continue;
    throw Error("the edge between vertices " + std::to_string(edge.vertex[0]) + " and " +
                std::to_string(edge.vertex[1]) +
                " turns by more than half a turn, which sch-core's format cannot hold; use the format stpbv");
  }
}

class Writer {
 public:
  explicit Writer(const StpBv& volume) : volume_(volume) {
    for (const StpBv::Ring& ring : volume.faces()) {
      firstTriangle_.push_back(triangleCount_);
      triangleCount_ += static_cast<int>(ring.size()) - 2;
    }
    for (int e = 0; e < volume.edgeCount(); ++e) {
      const StpBv::Edge& edge = volume.edges()[index(e)];
      edgeOf_[{edge.face[0], edge.vertex[0], edge.vertex[1]}] = e;
      edgeOf_[{edge.face[1], edge.vertex[1], edge.vertex[0]}] = e;
    }
  }

  std::string run() {
    numbers(volume_.radii().r, volume_.radii().R);
    vertices();
    faces();
    tori();
    return std::move(text_);
  }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  const Vector3d& vertex(int v) const { return volume_.vertices()[index(v)]; }
  const StpBv::Ring& ring(int face) const { return volume_.faces()[index(face)]; }
  int firstFace() const { return volume_.vertexCount(); }
  int firstTorus() const { return firstFace() + triangleCount_; }
  Vector3d ballCentre(int face) const {
    return unpack(posedPatch(volume_, volume_.facePatch(face)).centre());
  }
  Vector3d along(int from, int to) const { return (vertex(to) - vertex(from)).normalized(); }
  double cosine(int a, int b) const { return (vertex(b) - vertex(a)).norm() / (2 * volume_.radii().rho); }

  // Normal of the plane through a side and its ball's centre, which points into the face. It is computed from
  // the unit normal at the side's start, because the centre is far away.
  Vector3d sideNormal(int face, int a, int b) const {
    return volume_.corner(face, a).cross(vertex(b) - vertex(a)).normalized();
  }

  template <class... Doubles>
  void numbers(Doubles... values) {
    const std::size_t start = text_.size();
    ((text_ += text_.size() > start ? " " : "", appendNumber(text_, values)), ...);
    text_ += '\n';
  }
  void line(int id, const Vector3d& v) { text_ += std::to_string(id) + " ", numbers(v.x(), v.y(), v.z()); }
  void line(int id, double number, const Vector3d& v) {
    text_ += std::to_string(id) + " ", numbers(number, v.x(), v.y(), v.z());
  }
  void line(int value) { text_ += std::to_string(value) + "\n"; }

  void vertices() {
    line(volume_.vertexCount());
    std::vector<std::vector<std::pair<int, int>>> tori(
        index(volume_.vertexCount()));  // for each vertex: (edge, its other vertex)
    for (int e = 0; e < volume_.edgeCount(); ++e) {
      const StpBv::Edge& edge = volume_.edges()[index(e)];
      tori[index(edge.vertex[0])].push_back({e, edge.vertex[1]});
      tori[index(edge.vertex[1])].push_back({e, edge.vertex[0]});
    }
    for (int v = 0; v < volume_.vertexCount(); ++v) {
      const Vector3d& p = vertex(v);
      numbers(volume_.radii().r, p.x(), p.y(), p.z());
      line(static_cast<int>(tori[index(v)].size()));
      for (const auto& [edge, other] : tori[index(v)])
        line(firstTorus() + edge, cosine(v, other), along(other, v));
    }
  }

  // The neighbour of triangle t of a face's fan, over the side from corner `a` to corner `b`. The triangle
  // has the corners 0, t + 1, t + 2 of the ring.
  int neighbour(int face, int t, int a, int b) const {
    const int size = static_cast<int>(ring(face).size()),
              triangle = firstFace() + firstTriangle_[index(face)] + t;
    if (a == 0 && t > 0) return triangle - 1;
    if (b == 0 && t < size - 3) return triangle + 1;
    return firstTorus() + edgeOf_.at({face, ring(face)[index(a)], ring(face)[index(b)]});
  }

  void faces() {
    line(triangleCount_);
    for (int f = 0; f < volume_.faceCount(); ++f) {
      const Vector3d c = ballCentre(f);
      for (int t = 0; t + 2 < static_cast<int>(ring(f).size()); ++t) {
        const int corner[3] = {0, t + 1, t + 2};
        numbers(volume_.radii().R, c.x(), c.y(), c.z());
        for (int k : corner) appendVector(text_, vertex(ring(f)[index(k)])), text_ += k == t + 2 ? "\n" : " ";
        for (int k = 0; k < 3; ++k) {
          const int a = corner[k], b = corner[(k + 1) % 3];
          line(neighbour(f, t, a, b), sideNormal(f, ring(f)[index(a)], ring(f)[index(b)]));
        }
      }
    }
  }

  void torus(bool real, int i, int j, const Vector3d& middle, double kappa) {
    const Vector3d a = along(j, i);
    line(real);
    numbers(kappa, volume_.radii().R, middle.x(), middle.y(), middle.z(), a.x(), a.y(), a.z());
    line(i, cosine(i, j), a);
    line(j, cosine(i, j), -a);
  }

  // The triangle of a face's fan that contains the side of the ring that starts at the vertex `a`.
  int triangleAt(int face, int a) const {
    const StpBv::Ring& corners = ring(face);
    const int at = static_cast<int>(std::find(corners.begin(), corners.end(), a) - corners.begin());
    const int last = static_cast<int>(corners.size()) - 3;
    return firstFace() + firstTriangle_[index(face)] + std::clamp(at - 1, 0, last);
  }

  void tori() {
    line(volume_.edgeCount() + triangleCount_ - volume_.faceCount());
    for (int e = 0; e < volume_.edgeCount(); ++e) {
      const auto& [v, f, turn] = volume_.edges()[index(e)];
      const Patch patch = volume_.patch(volume_.edgePatch(e));
      torus(true, v[0], v[1], patch.anchor, patch.kappa);
      line(triangleAt(f[0], v[0]), sideNormal(f[0], v[0], v[1]));
      line(triangleAt(f[1], v[1]), sideNormal(f[1], v[1], v[0]));
    }
    for (int f = 0; f < volume_.faceCount(); ++f) {
      for (int t = 0; t + 3 < static_cast<int>(ring(f).size()); ++t) innerEdge(f, t);
    }
  }

  // The edge between the triangles t and t + 1 of a fan. It is side 31 of the first one and side 12 of the
  // second.
  void innerEdge(int f, int t) {
    const int i = ring(f)[index(t + 2)], j = ring(f)[0];
    const double half = 0.5 * (vertex(i) - vertex(j)).norm(), rho = volume_.radii().rho;
    const Vector3d middle = 0.5 * (vertex(i) + vertex(j));
    torus(false, i, j, middle, std::sqrt(std::max(0.0, (rho - half) * (rho + half))));
    const int triangle = firstFace() + firstTriangle_[index(f)] + t;
    line(triangle, sideNormal(f, i, j));
    line(triangle + 1, sideNormal(f, j, i));
  }

  const StpBv& volume_;
  std::string text_;
  int triangleCount_ = 0;
  std::vector<int> firstTriangle_;            // number of the first triangle of each face's fan
  std::map<std::array<int, 3>, int> edgeOf_;  // key: face, first and second vertex of a side in its ring
};

std::string schText(const StpBv& volume) {
  requireWritable(volume);
  return Writer(volume).run();
}

}  // namespace

void saveSch(const std::string& path, const StpBv& volume) {
  atomicWrite(path, within(path, [&] { return schText(volume); }));
}

void saveSch(std::ostream& out, const StpBv& volume) {
  writeStream(out, schText(volume), "an STP-BV in sch-core's format");
}

}  // namespace fcl_stpbv
