// Connected pieces of a mesh, and which of them enclose a space:
// 1. weld vertices with equal coordinates;
// 2. walk over shared edges from triangle to triangle, turning each to agree with its neighbour;
// 3. a piece is closed if every edge is run through equally often both ways.
#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/parts/mesh_solid.h"

namespace fcl_stpbv {
namespace {

using detail::at;

struct Edge {
  int low, high;
  int triangle;
  bool forward;  // runs from low to high
  bool sameAs(const Edge& other) const { return low == other.low && high == other.high; }
};

// Numbers for the points, equal ones sharing one.
std::vector<int> weld(const std::vector<Eigen::Vector3d>& points, std::vector<Eigen::Vector3d>& distinct) {
  std::vector<int> order(points.size()), number(points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int i) { return std::tie(points[at(i)].x(), points[at(i)].y(), points[at(i)].z()); };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  for (const int i : order) {
    if (distinct.empty() || distinct.back() != points[at(i)]) distinct.push_back(points[at(i)]);
    number[at(i)] = static_cast<int>(distinct.size()) - 1;
  }
  return number;
}

class Taker {
 public:
  explicit Taker(const TriangleMesh& mesh) {
    if (mesh.triangles.empty()) throw Error("the mesh has no triangles; give one that has");
    for (const Eigen::Vector3d& p : mesh.vertices)
      if (!p.allFinite())
        throw Error("the mesh has a coordinate that is not a finite number; export it again");
    const std::vector<int> number = weld(mesh.vertices, out_.vertices);
    for (const std::array<int, 3>& triangle : mesh.triangles) {
      std::array<int, 3> corners{};
      for (std::size_t k = 0; k < 3; ++k) {
        if (triangle[k] < 0 || at(triangle[k]) >= number.size())
          throw Error("the mesh has a triangle of a vertex that does not exist; export it again");
        corners[k] = number[at(triangle[k])];
      }
      (isLine(corners) ? lines_ : out_.triangles).push_back(corners);
    }
  }

  MeshPieces take() {
    sortEdges();
    spread();
    decideClosed();
    addLines();
    return std::move(out_);
  }

 private:
  static bool isLine(const std::array<int, 3>& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

  void sortEdges() {
    for (std::size_t t = 0; t < out_.triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = out_.triangles[t][k], b = out_.triangles[t][(k + 1) % 3];
        edges_.push_back({std::min(a, b), std::max(a, b), static_cast<int>(t), a < b});
      }
    }
    std::sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) {
      return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
    edgesOf_.resize(out_.triangles.size());
    for (std::size_t e = 0; e < edges_.size(); ++e)
      edgesOf_[at(edges_[e].triangle)].push_back(static_cast<int>(e));
  }

  // Edges equal to one: first and one past the last.
  std::pair<std::size_t, std::size_t> run(std::size_t e) const {
    std::size_t first = e, last = e;
    while (first > 0 && edges_[first - 1].sameAs(edges_[e])) --first;
    while (last < edges_.size() && edges_[last].sameAs(edges_[e])) ++last;
    return {first, last};
  }

  // Walks over edges from triangle to triangle, turning each to agree with the one it was reached from where
  // just two share the edge.
  void spread() {
    out_.piece.assign(out_.triangles.size(), -1);
    turned_.assign(out_.triangles.size(), 0);
    std::vector<char> passed(edges_.size(), 0);
    int pieces = 0;
    for (std::size_t start = 0; start < out_.triangles.size(); ++start) {
      if (out_.piece[start] >= 0) continue;
      std::vector<int> open{static_cast<int>(start)};
      out_.piece[start] = pieces;
      while (!open.empty()) {
        const int from = open.back();
        open.pop_back();
        for (const int e : edgesOf_[at(from)]) {
          const auto [first, last] = passed[at(e)] ? std::pair{at(e), at(e)} : run(at(e));
          for (std::size_t other = first; other < last; ++other) {
            passed[other] = 1;
            const int to = edges_[other].triangle;
            if (out_.piece[at(to)] >= 0) continue;
            out_.piece[at(to)] = pieces;
            const bool agrees = edges_[other].forward != edges_[at(e)].forward;
            turned_[at(to)] = turned_[at(from)] ^ static_cast<char>(last - first == 2 && !agrees);
            open.push_back(to);
          }
        }
      }
      ++pieces;
    }
    out_.closed.assign(at(pieces), 1);
    for (std::size_t t = 0; t < out_.triangles.size(); ++t)
      if (turned_[t]) std::swap(out_.triangles[t][1], out_.triangles[t][2]);
  }

  void decideClosed() {
    for (std::size_t e = 0; e < edges_.size();) {
      const std::size_t last = run(e).second;
      int balance = 0;
      const int piece = out_.piece[at(edges_[e].triangle)];
      for (; e < last; ++e)
        balance += edges_[e].forward != static_cast<bool>(turned_[at(edges_[e].triangle)]) ? 1 : -1;
      if (balance != 0) out_.closed[at(piece)] = 0;
    }
  }

  // A triangle with two equal corners is the edge of another, or a piece of its own.
  void addLines() {
    const auto less = [](const Edge& a, const Edge& b) {
      return std::tie(a.low, a.high) < std::tie(b.low, b.high);
    };
    for (const std::array<int, 3>& line : lines_) {
      const auto [low, high] = std::minmax_element(line.begin(), line.end());
      if (std::binary_search(edges_.begin(), edges_.end(), Edge{*low, *high, 0, true}, less)) continue;
      out_.triangles.push_back(line);
      out_.piece.push_back(out_.pieces());
      out_.closed.push_back(0);
    }
  }

  MeshPieces out_;
  std::vector<std::array<int, 3>> lines_;
  std::vector<Edge> edges_;
  std::vector<std::vector<int>> edgesOf_;
  std::vector<char> turned_;
};

}  // namespace

int MeshPieces::closedPieces() const {
  return static_cast<int>(std::count(closed.begin(), closed.end(), char{1}));
}

MeshPieces meshPieces(const TriangleMesh& mesh) { return Taker(mesh).take(); }

}  // namespace fcl_stpbv
