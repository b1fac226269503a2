// 1. Sort the triangles by their corners to find the copies; keep the first of each.
// 2. Collect copies that are connected by edges of exactly two triangles: a region.
// 3. If every edge of a region has an even number of triangles, the region is a part of a surface and stays
//    as it is. Otherwise it is a sheet, and each triangle gets a second one with the opposite orientation.
#include "fcl_stpbv/parts/mesh_copies.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

#include "fcl_stpbv/parts/mesh_edges.h"

namespace fcl_stpbv::detail {
namespace {

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

}  // namespace

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

}  // namespace fcl_stpbv::detail
