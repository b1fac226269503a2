// The half-edges of a growing surface whose other side is not known yet.
#pragma once

#include <cstddef>
#include <vector>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

/// Open half-edges, in one list for each vertex from which they start. A vertex has few, so that each is
/// found in a few steps.
class OpenEdges {
 public:
  explicit OpenEdges(std::size_t vertices) : first_(vertices, kNone) {}

  /// Adds the half-edge `from` -> `to` at a face's corner.
  void add(int from, int to, int face, int corner) {
    int& first = first_[at(from)];
    edges_.push_back({to, face, corner, first});
    first = static_cast<int>(edges_.size()) - 1;
  }

  /// Face of an open half-edge `from` -> `to`; -1 if there is none.
  int face(int from, int to) const {
    for (int e = first_[at(from)]; e != kNone; e = edge(e).next)
      if (edge(e).to == to) return edge(e).face;
    return kNone;
  }

  /// Removes the half-edge `from` -> `to` of this face. Returns its corner, or -1 if it is not open.
  int close(int from, int to, int face) {
    for (int* link = &first_[at(from)]; *link != kNone; link = &edge(*link).next) {
      const Edge found = edge(*link);
      if (found.to != to || found.face != face) continue;
      *link = found.next;
      return found.corner;
    }
    return kNone;
  }

 private:
  static constexpr int kNone = -1;
  struct Edge {
    int to, face, corner, next;
  };
  Edge& edge(int i) { return edges_[at(i)]; }
  const Edge& edge(int i) const { return edges_[at(i)]; }

  std::vector<int> first_;
  std::vector<Edge> edges_;
};

}  // namespace fcl_stpbv::detail
