// Two bodies at an answer: what a small motion of both does to the normal between their features.
#pragma once

#include <Eigen/Geometry>

#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/distance/turning.h"

namespace fcl_stpbv::detail {

/// Two bodies at an answer. The normal is carried by body 2 and turns in it by `tau`, the maximum of s over
/// the ways it may:
///
///     n = exp(w_B) (n0 + tau),   s = n.(o_B - o_A) - h_B(body 2's normal) - h_A(n seen from body 1)
///
/// so only body 1's radii of curvature, always finite, meet the twists, and body 2's only `tau`.
///
/// Where two edges cross they fix the normal between them, whatever is best for s:
/// `tau` then keeps it across body 1's edge, and the points slide along both.
struct Touch {
  Curvature a;
  Turning inverse;
  Eigen::Vector3d armA, fromB;  // body 1's witness point from both origins
  bool crossing = false;
  Eigen::Vector3d edge{0, 0, 0};  // along body 1's edge, edge.way = 1
  Eigen::Vector3d way{0, 0, 0};   // of the normal, around body 2's edge
  double stiffness = 0;           // W_B + delta along that way

  /// Where body 2's feature is not the more curved one. False where nothing has derivatives: `rounding` (m)
  /// of the distance is all that is left of the radii of curvature.
  bool set(const NormalCone& b, const Eigen::Isometry3d& poseA, const Eigen::Isometry3d& poseB,
           const Distance& d, double rounding);
  /// Two edges. False where they are parallel.
  bool cross(const NormalCone& first, const NormalCone& second, const Eigen::Isometry3d& poseA,
             const Eigen::Isometry3d& poseB, const Distance& d);

  /// What the gap's gradient has left over, along `way`, is how far the points slide along body 1's edge.
  template <typename Vector>
  auto left(const Vector& gradient, const Vector& turn) const {
    return (way.transpose() * (gradient - stiffness * turn) - (a * way).transpose() * turn).eval();
  }
};

/// The touch at the answer `d`. False where second derivatives do not exist.
bool touchOf(const StpBv& a, const Eigen::Isometry3d& poseA, const StpBv& b, const Eigen::Isometry3d& poseB,
             const Distance& d, Touch& touch);
bool touchOf(const StpBv& volume, const Eigen::Isometry3d& poseVolume, const Shape& shape,
             const Eigen::Isometry3d& poseShape, const Distance& d, Touch& touch);
/// Two shapes. `swapped`: the first one's feature is flatter than the second's, so that the touch is that of
/// the second with the first, at the answer `exchanged(d)`.
bool touchOf(const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b, const Eigen::Isometry3d& poseB,
             const Distance& d, Touch& touch, bool& swapped);

/// An answer with the bodies' names exchanged.
Distance exchanged(Distance d);

}  // namespace fcl_stpbv::detail
