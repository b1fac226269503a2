// Rotations that are almost ones: poses come from integrated joints, files and single precision.
#pragma once

#include <Eigen/Core>

namespace fcl_stpbv {

/// Makes the nearly orthonormal columns of a rotation orthonormal to rounding. False for columns that are not
/// finite or no rotation's.
bool makeOrthonormal(Eigen::Matrix3d& q);

}  // namespace fcl_stpbv
