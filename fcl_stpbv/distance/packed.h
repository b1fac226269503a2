// Vectors of three in one register, for the functions that make up a query.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstring>

namespace fcl_stpbv {

/// Three numbers side by side; the fourth means nothing. With Eigen's three, sums and products take two
/// instructions each and a cross product a dozen; its four would change their alignment with the caller's
/// compiler flags. Only functions that are compiled into their callers take or return one by value: how it is
/// passed depends on those flags too. The alignment is written down since it would depend on them as well,
/// while functions compiled for wider instructions (vectorized.h) rely on it; in a template's argument, a
/// `std::array`'s say, it would be lost.
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

}  // namespace fcl_stpbv
