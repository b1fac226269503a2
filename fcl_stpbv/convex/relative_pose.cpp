// The nearest rotation to a matrix that is almost one: Newton's iteration for the polar factor (Higham 1986).
//
// q (3 - q^T q) / 2 has the same polar factor as q and squares its error: from 3e-6 two steps reach rounding.
#include "fcl_stpbv/convex/relative_pose.h"

#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {

FCL_STPBV_VECTORIZED
bool makeRotation(Rotation& rotation) {
  constexpr double kNear = 3e-6;  // Frobenius norm of nine entries of 1e-6
  Eigen::Matrix3d q = rotation.matrix();
  const Eigen::Matrix3d first = q.transpose() * q - Eigen::Matrix3d::Identity();  // twice the error
  if (!(first.norm() <= 2.0 * kNear) || !(q.determinant() > 0.0)) return false;   // false for NaN
  q -= 0.5 * q * first;
  q -= 0.5 * q * (q.transpose() * q - Eigen::Matrix3d::Identity());
  rotation = Rotation(q);
  return true;
}

FCL_STPBV_VECTORIZED
bool makeRigid(Eigen::Isometry3d& pose) {
  Rotation rotation(pose);
  if (!rotation.isFine()) {
    if (!makeRotation(rotation)) return false;
    pose.linear() = rotation.matrix();
  }
  const Packed at = column(pose, 3), size = larger(at, -at);
  return size[0] < kFarthest && size[1] < kFarthest && size[2] < kFarthest;
}

FCL_STPBV_VECTORIZED
RelativePose relativePose(const Eigen::Isometry3d& poseA, const Eigen::Isometry3d& poseB) {
  return RelativePose(poseA, poseB);
}

}  // namespace fcl_stpbv::detail
