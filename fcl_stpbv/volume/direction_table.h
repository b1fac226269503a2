// A lookup table over all directions. It stores a search result for the middle of each cell, as a starting
// point for later searches.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fcl_stpbv::detail {

/// The sphere of directions as an octahedron whose lower half is folded out to a square of side x side cells.
class DirectionTable {
 public:
  DirectionTable() = default;

  /// Calls `find` with the middle of each cell, a unit vector, and stores the number that it returns. It goes
  /// row by row, so each direction is near the one before.
  template <typename Find>
  DirectionTable(int side, const Find& find) : side_(side) {
    entries_.reserve(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        const double x = (2.0 * i + 1.0) / side - 1.0, y = (2.0 * j + 1.0) / side - 1.0;
        Eigen::Vector3d n(x, y, 1.0 - std::abs(x) - std::abs(y));
        if (n.z() < 0) n.x() = std::copysign(1 - std::abs(y), x), n.y() = std::copysign(1 - std::abs(x), y);
        entries_.push_back(find(Eigen::Vector3d(n.normalized())));
      }
  }

  /// The entry of the cell that contains the direction `n` (any length). For a zero vector, the entry of some
  /// cell.
  int operator[](const Eigen::Vector3d& n) const { return entries_[cell(n)]; }

  int side() const { return side_; }
  bool empty() const { return entries_.empty(); }
  /// Memory that the table uses, in bytes.
  std::size_t memory() const { return entries_.capacity() * sizeof(std::int32_t); }

 private:
  std::size_t cell(const Eigen::Vector3d& n) const {
    const double half = 0.5 * side_, scale = half / n.lpNorm<1>();
    const double x = n.x() * scale, y = n.y() * scale;
    const double folded = n.z() < 0.0 ? 1.0 : 0.0;  // a factor, because a branch would be mispredicted
    const double u = x + folded * (std::copysign(half - std::abs(y), x) - x);
    const double v = y + folded * (std::copysign(half - std::abs(x), y) - y);
    // With the arguments of std::max in this order, NaN (from a zero `n`) becomes 0.
    const auto slot = [&](double along) {
      return static_cast<int>(std::min(std::max(0.0, along + half), side_ - 1.0));
    };
    return static_cast<std::size_t>(slot(u) * side_ + slot(v));
  }

  std::vector<std::int32_t> entries_;
  int side_ = 1;  // cells along a side of the square
};

}  // namespace fcl_stpbv::detail
