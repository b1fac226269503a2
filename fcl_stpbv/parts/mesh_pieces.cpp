// Connected pieces of a mesh, and which of them enclose a space:
// 1. weld vertices with equal coordinates;
// 2. merge triangles with the same corners, into one or into a sheet without an inside: faces that were
//    written twice or from both sides, and walls between bodies;
// 3. orient triangles like their neighbours, across edges with exactly two triangles;
// 4. a piece is closed if every edge is traversed equally often in both directions, and it does not consist
//    of sheets only.
#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/parts/mesh_edges.h"
#include "fcl_stpbv/parts/mesh_solid.h"

namespace fcl_stpbv {
namespace {

using namespace detail;

// Numbers the points; equal points get the same number.
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

using Corners = std::array<int, 3>;

// Leaves one triangle of each set of copies, in their order. @returns for each of these whether it had
// copies.
std::vector<char> takeFirsts(std::vector<Corners>& triangles) {
  std::vector<Corners> sorted = triangles;
  for (Corners& t : sorted) std::sort(t.begin(), t.end());
  std::vector<std::size_t> order(triangles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return sorted[a] < sorted[b]; });
  std::vector<char> isFirst(triangles.size(), 1), hasCopies(triangles.size(), 0);
  for (std::size_t i = 1, first = 0; i < order.size(); ++i) {
    if (sorted[order[i]] != sorted[order[first]]) {
      first = i;
    } else {
      isFirst[order[i]] = 0;
      hasCopies[order[first]] = 1;
    }
  }
  std::size_t kept = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (!isFirst[t]) continue;
    triangles[kept] = triangles[t];
    hasCopies[kept++] = hasCopies[t];
  }
  triangles.resize(kept);
  hasCopies.resize(kept);
  return hasCopies;
}

// Merges triangles with the same three corners, in any orientation. If an edge then has an odd number of
// triangles, as along a fin or around a wall between two bodies, the merged triangles are a sheet: two of
// them stay, with opposite orientations, which enclose nothing. Returns for each triangle whether it belongs
// to a sheet. Vertices with equal coordinates must have been merged before. Steps:
// 1. Sort the triangles by their corners to find the copies; keep the first of each.
// 2. Collect copies that are connected by edges of exactly two triangles: a region.
// 3. If every edge of a region has an even number of triangles, the region is a part of a surface and stays
//    as it is. Otherwise it is a sheet, and each triangle gets a second one with the opposite orientation.
std::vector<char> joinCopies(std::vector<Corners>& triangles) {
  std::vector<char> hasCopies = takeFirsts(triangles), sheet(triangles.size(), 0);
  if (std::find(hasCopies.begin(), hasCopies.end(), char{1}) == hasCopies.end()) return sheet;
  const MeshEdges edges(triangles);
  const std::size_t count = triangles.size();
  for (std::size_t start = 0; start < count; ++start) {
    if (!hasCopies[start]) continue;
    std::vector<std::size_t> region{start};
    hasCopies[start] = 0;
    bool even = true;
    for (std::size_t i = 0; i < region.size(); ++i) {
      for (const std::size_t e : edges.of(region[i])) {
        const std::size_t first = edges.startOfRun(e), last = edges.endOfRun(e);
        even = even && (last - first) % 2 == 0;
        if (last - first != 2) continue;
        const std::size_t other = at(edges[first == e ? first + 1 : first].triangle);
        if (std::exchange(hasCopies[other], char{0})) region.push_back(other);
      }
    }
    if (even) continue;
    for (const std::size_t t : region) {
      const auto [a, b, c] = triangles[t];
      triangles.push_back({a, c, b});
      sheet[t] = 1;
      sheet.push_back(1);
    }
  }
  return sheet;
}

class Taker {
 public:
  explicit Taker(const TriangleMesh& mesh) {
    if (mesh.triangles.empty()) throw Error("the mesh has no triangles; give one that has");
    for (const Eigen::Vector3d& p : mesh.vertices)
      if (!p.allFinite())
        throw Error("the mesh has a coordinate that is not a finite number; export it again");
    const std::vector<int> number = weld(mesh.vertices, out_.vertices);
    std::vector<char> used(out_.vertices.size(), 0);
    for (const Corners& triangle : mesh.triangles) {
      Corners corners{};
      for (std::size_t k = 0; k < 3; ++k) {
        if (triangle[k] < 0 || at(triangle[k]) >= number.size())
          throw Error("the mesh has a triangle of a vertex that does not exist; export it again");
        corners[k] = number[at(triangle[k])];
      }
      if (corners[0] == corners[1] && corners[1] == corners[2]) continue;  // only its vertex counts
      for (const int corner : corners) used[at(corner)] = 1;
      (isLine(corners) ? lines_ : out_.triangles).push_back(corners);
    }
    for (int i = 0; at(i) < used.size(); ++i)
      if (!used[at(i)]) lines_.push_back({i, i, i});
  }

  MeshPieces take() {
    sheet_ = joinCopies(out_.triangles);
    edges_ = MeshEdges(out_.triangles);
    findPartners();
    orient();
    connect();
    decideClosed();
    addLines();
    return std::move(out_);
  }

 private:
  static bool isLine(const Corners& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

  // Finds for each edge the other one, if exactly two triangles share it. Sheets do not count.
  void findPartners() {
    partner_.assign(edges_.size(), -1);
    std::vector<std::size_t> users;
    for (std::size_t first = 0; first < edges_.size();) {
      const std::size_t last = edges_.endOfRun(first);
      users.clear();
      for (; first < last; ++first)
        if (!sheet_[at(edges_[first].triangle)]) users.push_back(first);
      if (users.size() != 2) continue;
      partner_[users[0]] = static_cast<int>(users[1]);
      partner_[users[1]] = static_cast<int>(users[0]);
    }
  }

  void orient() {
    turned_.assign(out_.triangles.size(), 0);
    std::vector<char> seen(out_.triangles.size(), 0);
    for (std::size_t start = 0; start < seen.size(); ++start) {
      if (seen[start]) continue;
      std::vector<std::size_t> open{start};
      seen[start] = 1;
      while (!open.empty()) {
        const std::size_t from = open.back();
        open.pop_back();
        for (const std::size_t e : edges_.of(from)) {
          if (partner_[e] < 0) continue;
          const MeshEdge& other = edges_[at(partner_[e])];
          const std::size_t to = at(other.triangle);
          if (seen[to]) continue;
          seen[to] = 1;
          turned_[to] = turned_[from] ^ static_cast<char>(other.forward == edges_[e].forward);
          open.push_back(to);
        }
      }
    }
    for (std::size_t t = 0; t < out_.triangles.size(); ++t)
      if (turned_[t]) std::swap(out_.triangles[t][1], out_.triangles[t][2]);
  }

  void connect() {
    out_.piece.assign(out_.triangles.size(), -1);
    std::vector<char> passed(edges_.size(), 0);
    int pieces = 0;
    for (std::size_t start = 0; start < out_.piece.size(); ++start) {
      if (out_.piece[start] >= 0) continue;
      std::vector<std::size_t> open{start};
      out_.piece[start] = pieces;
      while (!open.empty()) {
        const std::size_t from = open.back();
        open.pop_back();
        for (const std::size_t e : edges_.of(from)) {
          if (passed[e]) continue;
          const std::size_t last = edges_.endOfRun(e);
          for (std::size_t other = edges_.startOfRun(e); other < last; ++other) {
            passed[other] = 1;
            const std::size_t to = at(edges_[other].triangle);
            if (out_.piece[to] >= 0) continue;
            out_.piece[to] = pieces;
            open.push_back(to);
          }
        }
      }
      ++pieces;
    }
    out_.closed.assign(at(pieces), 0);
  }

  void decideClosed() {
    for (std::size_t t = 0; t < out_.piece.size(); ++t)
      if (!sheet_[t]) out_.closed[at(out_.piece[t])] = 1;
    for (std::size_t e = 0; e < edges_.size();) {
      const std::size_t last = edges_.endOfRun(e);
      int balance = 0;
      const int piece = out_.piece[at(edges_[e].triangle)];
      for (; e < last; ++e)
        balance += edges_[e].forward != static_cast<bool>(turned_[at(edges_[e].triangle)]) ? 1 : -1;
      if (balance != 0) out_.closed[at(piece)] = 0;
    }
  }

  // A triangle with two equal corners is dropped if it is an edge of another triangle, or a copy. Otherwise
  // it becomes a piece of its own, and so does a point that no triangle uses. A point counts as closed,
  // because it has no inside.
  void addLines() {
    std::set<std::pair<int, int>> known;
    for (const Corners& line : lines_) {
      const auto [low, high] = std::minmax_element(line.begin(), line.end());
      if (edges_.has(*low, *high) || !known.emplace(*low, *high).second) continue;
      out_.triangles.push_back(line);
      out_.piece.push_back(out_.pieces());
      out_.closed.push_back(*low == *high);
    }
  }

  MeshPieces out_;
  std::vector<Corners> lines_;
  std::vector<char> sheet_;  // for each triangle
  MeshEdges edges_;
  std::vector<int> partner_;  // partner of each edge, or -1
  std::vector<char> turned_;  // for each triangle
};

}  // namespace

int MeshPieces::closedPieces() const {
  return static_cast<int>(std::count(closed.begin(), closed.end(), char{1}));
}

MeshPieces meshPieces(const TriangleMesh& mesh) { return Taker(mesh).take(); }

}  // namespace fcl_stpbv
