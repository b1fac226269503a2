// Four vectors at a time (structure of arrays): their x in one register, their y and z in two more.
#pragma once

#include <cmath>

#include "fcl_stpbv/packed.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"  // packed.h says why

namespace fcl_stpbv::detail {

struct FourVectors {
  Packed x, y, z;
};

/// The same vector four times.
inline FourVectors four(const Packed& v) { return {Packed{} + v[0], Packed{} + v[1], Packed{} + v[2]}; }

inline FourVectors four(const Packed& p, const Packed& q, const Packed& r, const Packed& s) {
  const Packed pqEven = __builtin_shufflevector(p, q, 0, 4, 2, 6),
               pqOdd = __builtin_shufflevector(p, q, 1, 5, 3, 7),
               rsEven = __builtin_shufflevector(r, s, 0, 4, 2, 6),
               rsOdd = __builtin_shufflevector(r, s, 1, 5, 3, 7);
  return {__builtin_shufflevector(pqEven, rsEven, 0, 1, 4, 5),
          __builtin_shufflevector(pqOdd, rsOdd, 0, 1, 4, 5),
          __builtin_shufflevector(pqEven, rsEven, 2, 3, 6, 7)};
}

inline FourVectors operator+(const FourVectors& a, const FourVectors& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline FourVectors operator-(const FourVectors& a, const FourVectors& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline FourVectors operator*(const Packed& f, const FourVectors& v) { return {f * v.x, f * v.y, f * v.z}; }

inline Packed dot(const FourVectors& a, const FourVectors& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

inline FourVectors cross(const FourVectors& a, const FourVectors& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline Packed roots(const Packed& v) {
  return Packed{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
}

/// Whether a comparison holds for all four vectors.
inline bool all(const PackedBits& holds) { return (holds[0] & holds[1] & holds[2] & holds[3]) != 0; }

/// Whether a comparison holds for at least one of the four vectors.
inline bool any(const PackedBits& holds) { return (holds[0] | holds[1] | holds[2] | holds[3]) != 0; }

}  // namespace fcl_stpbv::detail

#pragma GCC diagnostic pop
