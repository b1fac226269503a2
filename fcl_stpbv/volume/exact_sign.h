// Exact signs of the builder's two predicates, in integers, for cases that floating point cannot decide.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace fcl_stpbv::detail {

/// The ball of `radius` that touches a, b and c, counter-clockwise seen from outside. If the radius is
/// infinite, it is the half space below their plane.
struct BallPoints {
  Eigen::Vector3d a, b, c;
  double radius;
};

/// 1 if p lies outside the ball, 0 on it, -1 inside. The coordinates count exactly as they are, without
/// rounding.
int exactSide(const BallPoints& ball, const Eigen::Vector3d& p);

/// exactSide() for four points that lie exactly in one plane, such as corners of a flat face. It is fast, and
/// the result is the same for any radius. No value if the points are not coplanar, or if their coordinates
/// differ too much in size.
std::optional<int> coplanarSide(const BallPoints& ball, const Eigen::Vector3d& p);

/// 1 if p, q, s on the ball turn counter-clockwise seen from outside, 0 if they lie on one great circle, -1
/// otherwise.
int exactTurn(const BallPoints& ball, const Eigen::Vector3d& p, const Eigen::Vector3d& q,
              const Eigen::Vector3d& s);

}  // namespace fcl_stpbv::detail
