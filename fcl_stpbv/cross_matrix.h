// The cross product with a fixed vector as a matrix (skew-symmetric).
#pragma once

#include <Eigen/Core>

namespace fcl_stpbv::detail {

/// The matrix whose product with a vector v is the cross product of `w` and v.
inline Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& w) {
  Eigen::Matrix3d m;
  m << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return m;
}

}  // namespace fcl_stpbv::detail
