// How good the features of FCL's polyhedral witness were as starts, counted over queries.
#pragma once

namespace fcl_stpbv {

/// How good the mapped patches turned out to be, counted over queries (paper IV.B: 0.3 % were wrong, nearly
/// all of them by one neighbour).
struct MappingCounts {
  long right = 0;      ///< both mapped patches own the answer's normal
  long neighbour = 0;  ///< at least one is a direct neighbour of the patch that does, none is farther
  long farther = 0;    ///< at least one is farther away
  long unmapped = 0;   ///< no feature to map: the polyhedra overlap, or were not decided

  /// Queries counted.
  long total() const { return right + neighbour + farther + unmapped; }
  /// Adds another count.
  MappingCounts& operator+=(const MappingCounts& other) {
    right += other.right;
    neighbour += other.neighbour;
    farther += other.farther;
    unmapped += other.unmapped;
    return *this;
  }
};

}  // namespace fcl_stpbv
