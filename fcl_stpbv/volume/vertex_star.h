// The way from a vertex to its neighbours, packed for climbing.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <cstring>

namespace fcl_stpbv {

/// Unit directions of up to eight edges away from a vertex, single precision, unused ones zero. A vertex with
/// more has another star, which `next` names.
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

  /// How steeply the steepest edge rises along `d`, as the bits of a float with the edge's slot in place of
  /// the three least ones: as integers they compare as positive floats do. No branches, four edges at once.
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

}  // namespace fcl_stpbv
