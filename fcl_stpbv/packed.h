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
/// products would take two instructions each and a cross product a dozen. Eigen's Vector4d has an alignment
/// that depends on the caller's compiler flags. The way in which a Packed is passed depends on them too, so
/// only inlined functions take or return one by value. The alignment is given explicitly, because functions
/// compiled for wider instructions (vectorized.h) rely on it. If the type were a template argument, as in
/// `std::array`, it would lose this alignment.
using Packed = double __attribute__((vector_size(32), aligned(32)));

inline Packed pack(const Eigen::Vector3d& v) { return Packed{v.x(), v.y(), v.z(), v.z()}; }
/// Column `i` of a pose's matrix: 0 to 2 are the axes, 3 is the origin.
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

/// `v` with its fourth number replaced.
inline Packed withFourth(const Packed& v, double fourth) {
  return __builtin_shufflevector(v, Packed{} + fourth, 0, 1, 2, 4);
}

/// The bits of the four numbers.
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

/// Masks for exclusive or that flip the signs of the first three numbers, or of the fourth one.
constexpr std::int64_t kSign = std::numeric_limits<std::int64_t>::min();
constexpr PackedBits kOpposite3{kSign, kSign, kSign, 0}, kOppositeFourth{0, 0, 0, kSign};

/// Four sums: all four numbers of `p`, of `q`, of `r` and of `s`.
inline Packed sums(const Packed& p, const Packed& q, const Packed& r, const Packed& s) {
  const Packed pq = __builtin_shufflevector(p, q, 0, 4, 2, 6) + __builtin_shufflevector(p, q, 1, 5, 3, 7),
               rs = __builtin_shufflevector(r, s, 0, 4, 2, 6) + __builtin_shufflevector(r, s, 1, 5, 3, 7);
  return __builtin_shufflevector(pq, rs, 0, 1, 4, 5) + __builtin_shufflevector(pq, rs, 2, 3, 6, 7);
}

/// larger(): the larger of two numbers, for each of the four places. largest(): the largest of the four
/// numbers.
inline Packed larger(const Packed& v, const Packed& w) { return v > w ? v : w; }
inline double largest(const Packed& v) {
  const Packed two = larger(v, __builtin_shufflevector(v, v, 2, 3, 0, 1));
  return two[0] > two[1] ? two[0] : two[1];
}

}  // namespace fcl_stpbv::detail

#pragma GCC diagnostic pop
