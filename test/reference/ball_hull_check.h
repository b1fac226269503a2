// Bounds on a ball hull's support function from the points alone, in long double, by code that shares nothing
// with the library.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fcl_stpbv::test {

/// The result of checking a claim about the core, which is the ball hull of `points` for balls of radius
/// `rho` (m).
struct BallHullClaim {
  double outside;  ///< how far a point is outside the claimed ball: above 0 the support may be larger than
                   ///< claimed
  double beyond;   ///< how far the claim is above a proven lower bound on the support
};

/// Checks the claim that the core's surface point with the unit outward normal `n` is `x`. If the ball of
/// radius `rho` through `x` with that normal contains all points, the support is at most n.x. For weights w_i
/// on points, with sum 1, let y = sum w_i p_i and V = sum w_i |p_i - y|^2. Every centre C of a ball that
/// contains the points has |C - y|^2 <= rho^2 - V. So the support is at least rho + n.y - sqrt(rho^2 - V).
/// All triples of the points that the ball touches are tried.
BallHullClaim checkBallHull(const std::vector<Eigen::Vector3d>& points, double rho, const Eigen::Vector3d& n,
                            const Eigen::Vector3d& x);

}  // namespace fcl_stpbv::test
