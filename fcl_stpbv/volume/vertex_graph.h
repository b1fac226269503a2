// The edge graph of a volume's vertices, packed for fast hill climbing.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

/// Unit directions of up to eight edges that leave a vertex, in single precision. Unused places repeat the
/// last edge; they are zero if there is no edge. A vertex with more edges has a further star, with the index
/// `next`.
struct VertexStar {
  static constexpr int kSize = 8;
  using Floats = float __attribute__((vector_size(16)));
  using Integers = std::int32_t __attribute__((vector_size(16)));

  std::array<Floats, 2> x{}, y{}, z{};
  std::array<std::int32_t, kSize> neighbour{};
  std::int32_t next = -1;

  void set(std::size_t slot, const Eigen::Vector3f& direction, int to) {
    x[slot / 4][slot % 4] = direction.x();
    y[slot / 4][slot % 4] = direction.y();
    z[slot / 4][slot % 4] = direction.z();
    neighbour[slot] = to;
  }

  /// The slope of the edge that is steepest along `d`, as the bits of a float whose three lowest bits are
  /// replaced by the edge's slot. As integers these values compare like positive floats. Branch-free, four
  /// edges at a time.
  std::int32_t steepest(const Eigen::Vector3f& d, float lift = 0.0f) const {
    constexpr std::array<Integers, 2> slots{Integers{0, 1, 2, 3}, Integers{4, 5, 6, 7}};
    const auto rises = [&](std::size_t half) {
      const Floats rise = lift + d.x() * x[half] + d.y() * y[half] + d.z() * z[half];
      Integers key;
      std::memcpy(&key, &rise, sizeof key);
      return Integers((key & ~(kSize - 1)) | slots[half]);
    };
    const auto larger = [](const Integers& a, const Integers& b) { return Integers(a > b ? a : b); };
    Integers best = larger(rises(0), rises(1));
    best = larger(best, __builtin_shufflevector(best, best, 2, 3, 0, 1));
    best = larger(best, __builtin_shufflevector(best, best, 1, 0, 3, 2));
    return best[0];
  }
};

/// Hill climbing over a volume's vertices along its edges, in single precision.
class VertexGraph {
 public:
  VertexGraph() = default;
  /// `edges`: the two ends of each edge.
  VertexGraph(const std::vector<Eigen::Vector3d>& vertices, const std::vector<std::array<int, 2>>& edges);

  /// Rounding of a rise along `d`, as a share of the sum of the absolute components of `d`.
  static constexpr float kLevel = 1e-6f;

  /// The vertex itself, or its neighbour up the steepest edge along `d`. Edges that rise by less than `level`
  /// per metre count as level. `kLevel` times the sum of the absolute components of `d` allows for rounding.
  int uphill(int vertex, const Eigen::Vector3f& d, float level) const {
    const VertexStar* star = &stars_[at(vertex)];
    std::int32_t best = star->steepest(d), enough;
    std::memcpy(&enough, &level, sizeof level);
    int over = star->neighbour[best & (VertexStar::kSize - 1)];
    while (star->next >= 0) {
      star = &stars_[at(star->next)];
      const std::int32_t other = star->steepest(d);
      if (other > best) best = other, over = star->neighbour[other & (VertexStar::kSize - 1)];
    }
    return best > enough ? over : vertex;
  }

  /// For a vertex that is the highest one along `d`: its neighbour over the edge that descends least.
  /// `length` is at least the length of `d`.
  int beside(int vertex, const Eigen::Vector3f& d, float length) const {
    const VertexStar& star = stars_[at(vertex)];
    return star.neighbour[star.steepest(d, 2.0f * length) & (VertexStar::kSize - 1)];
  }

  /// The vertex furthest along `d` to single precision. The climb starts at `vertex`.
  int climb(int vertex, const Eigen::Vector3f& d) const;

  /// Memory that the graph uses, in bytes.
  std::size_t memory() const { return stars_.capacity() * sizeof(VertexStar); }

 private:
  std::vector<VertexStar> stars_;  // one for each vertex, then the further stars
};

}  // namespace fcl_stpbv::detail
