// The edges of a mesh's triangles, sorted so that edges between the same two vertices are neighbours.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <vector>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

/// An edge of one triangle. `forward`: whether it runs from `low` to `high` in the triangle.
struct MeshEdge {
  int low, high;
  int triangle;
  bool forward;
  bool sameAs(const MeshEdge& other) const { return low == other.low && high == other.high; }
};

class MeshEdges {
 public:
  MeshEdges() = default;
  explicit MeshEdges(const std::vector<std::array<int, 3>>& triangles) : ofTriangle_(triangles.size()) {
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = triangles[t][k], b = triangles[t][(k + 1) % 3];
        edges_.push_back({std::min(a, b), std::max(a, b), static_cast<int>(t), a < b});
      }
    }
    std::sort(edges_.begin(), edges_.end(), [](const MeshEdge& a, const MeshEdge& b) {
      return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
    std::vector<std::size_t> count(triangles.size(), 0);
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const std::size_t t = at(edges_[e].triangle);
      ofTriangle_[t][count[t]++] = e;
      if (e == 0 || !edges_[e].sameAs(edges_[e - 1])) runs_.push_back(e);
      run_.push_back(runs_.size() - 1);
    }
    runs_.push_back(edges_.size());
  }

  std::size_t size() const { return edges_.size(); }
  const MeshEdge& operator[](std::size_t e) const { return edges_[e]; }

  /// The three edges of a triangle.
  const std::array<std::size_t, 3>& of(std::size_t triangle) const { return ofTriangle_[triangle]; }

  /// The first of the edges between the same two vertices, and one past the last.
  std::size_t startOfRun(std::size_t e) const { return runs_[run_[e]]; }
  std::size_t endOfRun(std::size_t e) const { return runs_[run_[e] + 1]; }

  /// Whether a triangle has an edge between two vertices.
  bool has(int low, int high) const {
    return std::binary_search(edges_.begin(), edges_.end(), MeshEdge{low, high, 0, true},
                              [](const MeshEdge& a, const MeshEdge& b) {
                                return std::tie(a.low, a.high) < std::tie(b.low, b.high);
                              });
  }

 private:
  std::vector<MeshEdge> edges_;
  std::vector<std::size_t> run_, runs_;  // index of the run of each edge; where each run begins, and the end
  std::vector<std::array<std::size_t, 3>> ofTriangle_;
};

}  // namespace fcl_stpbv::detail
