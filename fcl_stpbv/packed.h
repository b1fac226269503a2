// Vectors of three numbers in one SIMD register, for the inner functions of queries.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <cstring>
#include <limits>

// Without AVX, GCC warns about the calling convention for such a vector. It does not matter here: only
// inlined functions take or return one by value.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

namespace fcl_stpbv::detail {

/// Three numbers side by side; the fourth is undefined unless documented. With Eigen's Vector3d, sums and
/// products take two instructions each and a cross product a dozen. The alignment of Eigen's Vector4d would
/// depend on the caller's compiler flags, and so does how such a vector is passed: only inlined functions
/// take or return one by value. The alignment is given explicitly, because functions compiled for wider
/// instructions (vectorized.h) rely on it. As a template argument, as in `std::array`, it would be lost.
using Packed = double __attribute__((vector_size(32), aligned(32)));

inline Packed pack(const Eigen::Vector3d& v) { return Packed{v.x(), v.y(), v.z(), v.z()}; }
/// A column of a pose's matrix: an axis, or with 3 the origin.
inline Packed column(const Eigen::Isometry3d& pose, Eigen::Index i) {
  Packed c;
  std::memcpy(&c, pose.matrix().col(i).data(), sizeof c);
  return c;
}

inline Eigen::Vector3d unpack(const Packed& v) { return {v[0], v[1], v[2]}; }

inline double dot(const Packed& a, const Packed& b) {
  const Packed m = a * b;
  return m[0] + m[1] + m[2];
}

inline Packed cross(const Packed& a, const Packed& b) {
  const auto turned = [](const Packed& v) { return __builtin_shufflevector(v, v, 1, 2, 0, 3); };
  const Packed c = a * turned(b) - turned(a) * b;
  return turned(c);
}

/// `v` with another fourth number.
inline Packed withFourth(const Packed& v, double fourth) {
  return __builtin_shufflevector(v, Packed{} + fourth, 0, 1, 2, 4);
}

/// The numbers' bits.
using PackedBits = std::int64_t __attribute__((vector_size(32), aligned(32)));

inline PackedBits bitsOf(const Packed& v) {
  PackedBits bits;
  std::memcpy(&bits, &v, sizeof bits);
  return bits;
}
inline Packed fromBits(const PackedBits& bits) {
  Packed v;
  std::memcpy(&v, &bits, sizeof v);
  return v;
}

/// Masks that flip signs by exclusive or.
constexpr std::int64_t kSign = std::numeric_limits<std::int64_t>::min();
constexpr PackedBits kOpposite3{kSign, kSign, kSign, 0}, kOppositeFourth{0, 0, 0, kSign};

/// The sums over all four numbers of each.
inline Packed sums(const Packed& p, const Packed& q, const Packed& r, const Packed& s) {
  const Packed pq = __builtin_shufflevector(p, q, 0, 4, 2, 6) + __builtin_shufflevector(p, q, 1, 5, 3, 7),
               rs = __builtin_shufflevector(r, s, 0, 4, 2, 6) + __builtin_shufflevector(r, s, 1, 5, 3, 7);
  return __builtin_shufflevector(pq, rs, 0, 1, 4, 5) + __builtin_shufflevector(pq, rs, 2, 3, 6, 7);
}

/// The larger ones, number by number, and the largest.
inline Packed larger(const Packed& v, const Packed& w) { return v > w ? v : w; }
inline double largest(const Packed& v) {
  const Packed two = larger(v, __builtin_shufflevector(v, v, 2, 3, 0, 1));
  return two[0] > two[1] ? two[0] : two[1];
}

}  // namespace fcl_stpbv::detail

#pragma GCC diagnostic pop
