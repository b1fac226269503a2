// Signs of the builder's two predicates in integers, where floating point cannot tell.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace fcl_stpbv::detail {

/// The ball of `radius` that touches a, b and c, counter-clockwise seen from outside; infinite: their plane.
struct BallPoints {
  Eigen::Vector3d a, b, c;
  double radius;
};

/// 1 where p lies outside the ball, 0 on it, -1 inside. No rounding: the coordinates as they are.
int exactSide(const BallPoints& ball, const Eigen::Vector3d& p);

/// The same where all four points lie exactly in one plane, as corners of a flat face do: quick, and for any
/// radius the same. None where they do not, or their coordinates differ too much in size.
std::optional<int> coplanarSide(const BallPoints& ball, const Eigen::Vector3d& p);

/// 1 where p, q, s on the ball turn counter-clockwise seen from outside, 0 on one great circle, -1 otherwise.
int exactTurn(const BallPoints& ball, const Eigen::Vector3d& p, const Eigen::Vector3d& q,
              const Eigen::Vector3d& s);

}  // namespace fcl_stpbv::detail
