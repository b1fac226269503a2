// A rotation matrix packed so that turning a vector, either way, adds up whole columns.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "fcl_stpbv/packed.h"

namespace fcl_stpbv {

/// A 3x3 matrix, its columns and its rows: `m v` and `m^T v` are then sums of three multiples without a sum
/// across, which would cost more than the multiplications.
class Rotation {
 public:
  /// From its columns.
  Rotation(const Packed& x, const Packed& y, const Packed& z) : columns_{x, y, z} {
    const Packed even = __builtin_shufflevector(x, y, 0, 4, 2, 6),
                 odd = __builtin_shufflevector(x, y, 1, 5, 3, 7);
    rows_[0] = __builtin_shufflevector(even, z, 0, 1, 4, 7);
    rows_[1] = __builtin_shufflevector(odd, z, 0, 1, 5, 7);
    rows_[2] = __builtin_shufflevector(even, z, 2, 3, 6, 7);
  }

  /// A pose's.
  explicit Rotation(const Eigen::Isometry3d& pose)
      : Rotation(column(pose, 0), column(pose, 1), column(pose, 2)) {}

  explicit Rotation(const Eigen::Matrix3d& m) : Rotation(pack(m.col(0)), pack(m.col(1)), pack(m.col(2))) {}

  /// The rotation of `pose` as seen from this one's frame: this one's inverse times it.
  Rotation relative(const Eigen::Isometry3d& pose) const {
    return {inverse(column(pose, 0)), inverse(column(pose, 1)), inverse(column(pose, 2))};
  }

  /// Whether the columns are orthonormal to the rounding of a product of two rotations.
  bool orthonormal() const {
    constexpr double kFine = 4e-15;
    const Packed x = inverse(columns_[0]) - Packed{1, 0, 0, 0}, y = inverse(columns_[1]) - Packed{0, 1, 0, 0},
                 z = inverse(columns_[2]) - Packed{0, 0, 1, 0}, squares = x * x + y * y + z * z;
    return squares[0] + squares[1] + squares[2] <= kFine * kFine;
  }

  /// The columns.
  Eigen::Matrix3d matrix() const {
    Eigen::Matrix3d m;
    m << unpack(columns_[0]), unpack(columns_[1]), unpack(columns_[2]);
    return m;
  }

  Packed operator*(const Packed& v) const { return sum(columns_, v); }
  Packed inverse(const Packed& v) const { return sum(rows_, v); }
  Eigen::Vector3d operator*(const Eigen::Vector3d& v) const { return unpack(sum(columns_, v)); }
  Eigen::Vector3d inverse(const Eigen::Vector3d& v) const { return unpack(sum(rows_, v)); }

 private:
  using Vectors = Packed[3];

  template <typename Vector>
  static Packed sum(const Vectors& m, const Vector& v) {
    return v[0] * m[0] + v[1] * m[1] + v[2] * m[2];
  }

  Vectors columns_, rows_;
};

}  // namespace fcl_stpbv
