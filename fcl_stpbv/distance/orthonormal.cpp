#include "fcl_stpbv/distance/orthonormal.h"

#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv {

FCL_STPBV_VECTORIZED
bool makeOrthonormal(Eigen::Matrix3d& q) {
  constexpr double kRotation = 0.1, kFine = 2e-15;
  // Newton for the polar factor, q (3 - q^T q) / 2: the error squares.
  for (int i = 0; i < 5; ++i) {
    const Eigen::Matrix3d error = q.transpose() * q - Eigen::Matrix3d::Identity();
    const double size = error.norm();
    if (!(size < kRotation)) return false;  // also what is not a number
    if (size <= kFine) break;
    q -= 0.5 * q * error;
  }
  return true;
}

}  // namespace fcl_stpbv
