// The ball through three points in double precision, with the exact predicate as a fallback.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>

#include "fcl_stpbv/volume/ball_side.h"

namespace fcl_stpbv::detail {

/// A TouchingBall (ball_side.h) that decides in double precision where this is certain. It is certain for
/// nearly all points and takes a dozen operations. The exact ball is made when a point first needs it. The
/// radius is finite, and the three points must stay where they are.
class QuickBall {
 public:
  QuickBall() = default;
  QuickBall(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, double radius);

  /// False if the points lie on a line, or if no ball of this radius can touch all three.
  bool valid() const { return valid_; }

  /// 1 if p lies outside the ball, 0 if it lies on the surface, -1 if it lies inside, without error. `height`
  /// becomes p's height over the surface, to rounding (m).
  int side(const Eigen::Vector3d& p, double* height) {
    const Eigen::Vector3d q = p - anchor_;
    *height = q.dot(halfCurvature_ * q + normal_);
    const double certain = error_ * q.lpNorm<1>();
    if (*height > certain) return 1;
    if (*height < -certain) return -1;
    return exactSide(p);
  }

  /// Bound on the error of the height that side() gives (m).
  double heightError(const Eigen::Vector3d& p) const { return error_ * (p - anchor_).lpNorm<1>(); }

 private:
  TouchingBall& exact();
  int exactSide(const Eigen::Vector3d& p);

  // One of the three points; the unit outward normal there.
  Eigen::Vector3d anchor_{0, 0, 0}, normal_{0, 0, 0};
  double halfCurvature_ = 0;
  double error_ = 0;  // bound on a height's error for each metre of distance from the anchor in the 1-norm
  bool valid_ = false;
  std::array<const Eigen::Vector3d*, 3> touched_{};
  double radius_ = 0;
  std::unique_ptr<TouchingBall> exact_;
};

}  // namespace fcl_stpbv::detail
