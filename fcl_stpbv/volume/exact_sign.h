// Signs of the builder's two predicates in integers, where floating point cannot tell.
#pragma once

#include <Eigen/Core>

namespace fcl_stpbv::detail {

/// The ball of `radius` that touches a, b and c, counter-clockwise seen from outside; infinite: their plane.
struct BallPoints {
  Eigen::Vector3d a, b, c;
  double radius;
};

/// 1 where p lies outside the ball, 0 on it, -1 inside. No rounding: the coordinates as they are.
int exactSide(const BallPoints& ball, const Eigen::Vector3d& p);

/// 1 where p, q, s on the ball turn counter-clockwise seen from outside, 0 on one great circle, -1 otherwise.
int exactTurn(const BallPoints& ball, const Eigen::Vector3d& p, const Eigen::Vector3d& q,
              const Eigen::Vector3d& s);

/// False where a, b and c lie exactly on one line.
bool spanPlane(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace fcl_stpbv::detail
