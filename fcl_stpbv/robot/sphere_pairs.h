// Finds the pairs of bodies whose bounding spheres do not prove them clear. One array is processed, four
// pairs at a time (SIMD).
#pragma once

#include <cstddef>
#include <vector>

#include "fcl_stpbv/robot/kept_plane.h"

namespace fcl_stpbv::detail {

/// A pair that its spheres do not prove clear.
struct NearPair {
  int pair;
  double apart2;  ///< squared distance of the centres (m^2)
};

/// The pairs of a fixed list.
class SpherePairs {
 public:
  /// Makes room for this number of pairs. No pair is set yet.
  void resize(std::size_t pairs);
  /// Sets a pair: spheres `a` and `b` are clear if their centres are farther apart than `reach` (m).
  void set(std::size_t pair, std::size_t a, std::size_t b, double reach);

  /// Compares all pairs. The two centres of a pair are off by up to `slack` together (m). Values that are not
  /// finite are not clear.
  void compare(const std::vector<SphereCentre>& centre, double slack);
  /// The pairs that are not clear, ascending until the caller sorts them.
  NearPair* begin() { return near_.data(); }
  NearPair* end() { return near_.data() + nearCount_; }

 private:
  static constexpr std::size_t kLanes = 4;
  struct Four {
    std::size_t a[kLanes], b[kLanes];
    Packed reach;
  };

  std::vector<Four> fours_;
  std::vector<NearPair> near_;
  std::size_t count_ = 0, nearCount_ = 0;
};

}  // namespace fcl_stpbv::detail
