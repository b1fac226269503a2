// A rotation matrix packed so that turning a vector, either way, adds up whole columns.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstring>

namespace fcl_stpbv {

/// A 3x3 matrix, its columns and its rows as a pair and a single number each: `m v` and `m^T v` are then sums of three
/// multiples without a sum across, which would cost more than the multiplications.
class Rotation {
 public:
  /// From its columns.
  Rotation(const Eigen::Vector3d& x, const Eigen::Vector3d& y, const Eigen::Vector3d& z)
      : Rotation(x.data(), y.data(), z.data()) {}

  /// Of a matrix whose columns are contiguous.
  template <typename Matrix>
  explicit Rotation(const Matrix& m) : Rotation(m.col(0).data(), m.col(1).data(), m.col(2).data()) {}

  Eigen::Vector3d operator*(const Eigen::Vector3d& v) const { return columns_.combined(v); }
  Eigen::Vector3d inverse(const Eigen::Vector3d& v) const { return rows_.combined(v); }

 private:
  Rotation(const double* x, const double* y, const double* z) {
    columns_ = {{load(x), load(y), load(z)}, {x[2], y[2], z[2]}};
    const auto& [p, q, r] = columns_.xy;
    rows_ = {{Pair{p[0], q[0]}, Pair{p[1], q[1]}, Pair{x[2], y[2]}}, {r[0], r[1], z[2]}};
  }

  using Pair = double __attribute__((vector_size(16)));

  struct Vectors {
    std::array<Pair, 3> xy;
    std::array<double, 3> z;

    Eigen::Vector3d combined(const Eigen::Vector3d& v) const {
      const Pair pair = v.x() * xy[0] + v.y() * xy[1] + v.z() * xy[2];
      Eigen::Vector3d sum;
      std::memcpy(sum.data(), &pair, sizeof pair);
      sum.z() = v.x() * z[0] + v.y() * z[1] + v.z() * z[2];
      return sum;
    }
  };

  static Pair load(const double* two) {
    Pair pair;
    std::memcpy(&pair, two, sizeof pair);
    return pair;
  }

  Vectors columns_, rows_;
};

}  // namespace fcl_stpbv
