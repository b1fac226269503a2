// The geometric predicate of the builder: is a point inside or outside of the ball through three other
// points?
#pragma once

#include <Eigen/Core>
#include <memory>

namespace fcl_stpbv::detail {

/// Ball of a given radius that touches three points, counter-clockwise seen from outside, from the
/// inside of their hull (paper III.A). An infinite radius makes it the half space below their plane, so
/// that the same code builds ball hulls and convex hulls.
///
/// The height of a point p over the ball's surface, to first order, is `kappa |q|^2 / 2 + q.m`
/// with `q = p - a`, `kappa` the curvature and `m` the unit outward normal at the first point a.
/// This form contains no large number for any radius. Its sign is computed in long double if that is certain,
/// else in quadruple precision, else in exact integers.
class TouchingBall {
 public:
  TouchingBall(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, double radius);

  /// False if the points lie on a line, or if no ball of this radius can touch all three.
  bool valid() const { return valid_; }

  /// Unit outward normal at the first point touched, and a bound on its error.
  const Eigen::Vector3d& normal() const { return normal_; }
  double normalError() const { return normalError_; }

  /// Unit outward normal at another touched point.
  Eigen::Vector3d normalAt(const Eigen::Vector3d& p) const;

  /// Height of p over the surface (m), in long double.
  long double height(const Eigen::Vector3d& p) const;

  /// 1 if p lies outside the ball, 0 if it lies on the surface, -1 if it lies inside.
  int side(const Eigen::Vector3d& p) const;

  /// 1 if the touched points p, q, s turn counter-clockwise on the ball seen from outside, 0 if they lie on
  /// one great circle, -1 otherwise.
  int turn(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& s) const;

 private:
  struct Exact;  // the same ball in quadruple precision
  const Exact& exact() const;

  Eigen::Vector3d anchor_, b_, c_;
  double radius_;
  bool valid_ = false;
  long double kappa_ = 0;
  long double m_[3] = {0, 0, 0};
  Eigen::Vector3d normal_{0, 0, 0};
  double normalError_ = 0;
  double condition_ = 1;  // factor by which the shape of the three points' triangle magnifies rounding in m
  mutable std::shared_ptr<const Exact> exact_;
};

}  // namespace fcl_stpbv::detail
